/*
 * csv.c: `read_csv`: tables of cells: RFC 4180, with numbers where a cell is one.
 */
#include "compiler/eval/data/data.h"

#include <string.h>

typedef struct Table {
    DataText *data;
    char      separator;
    size_t    columns; /* of the first row that counts; 0: none yet */
    Values    rows;
} Table;

static bool is_blank(char c) { return c == ' ' || c == '\t'; }

static bool at_end(const DataText *data) { return data->at >= data->length; }

static bool at_line_end(const DataText *data)
{
    return at_end(data) || data->text[data->at] == '\n' || data->text[data->at] == '\r';
}

static void skip_line_end(DataText *data)
{
    data->at += !at_end(data) && data->text[data->at] == '\r';
    data->at += !at_end(data) && data->text[data->at] == '\n';
}

/* Reads a cell from its first quote on; two quotes are one in the text. */
static Value quoted_cell(const Table *table)
{
    DataText *data       = table->data;
    uint32_t  start      = data->at++;
    data->scratch.length = 0;
    text_add(&data->scratch, "");
    for (; !at_end(data); data->at++) {
        bool quote = data->text[data->at] == '"';
        if (quote && data->text[data->at + 1] != '"')
            break;
        data->at += quote;
        text_add_bytes(&data->scratch, data->text + data->at, 1);
    }
    if (at_end(data)) {
        data_error(data, start, start + 1, "a quote that is not closed");
        return value_error();
    }
    data->at++;
    if (at_line_end(data) || data->text[data->at] == table->separator)
        return data_string(data, start, data->at);
    Diag *diag = data_error(data, data->at, data->at + 1, "a cell goes on behind its quotes");
    diag->help = "two quotes within quotes are one, as in `\"5\"\" pipe\"`";
    return value_error();
}

static Value plain_cell(const Table *table)
{
    DataText *data  = table->data;
    uint32_t  start = data->at;
    while (!at_line_end(data) && data->text[data->at] != table->separator)
        data->at++;
    uint32_t end = data->at;
    while (start < end && is_blank(data->text[start]))
        start++;
    while (start < end && is_blank(data->text[end - 1]))
        end--;
    if (start < end && data_number_length(data, start, false) == end - start)
        return data_number(data, start, end);
    data->scratch.length = 0;
    text_add_bytes(&data->scratch, data->text + start, end - start);
    return data_string(data, start, end);
}

static Value cell(const Table *table)
{
    return table->data->text[table->data->at] == '"' ? quoted_cell(table) : plain_cell(table);
}

/* Reads the cells of a row; false: reported. */
static bool read_row(const Table *table, Values *cells)
{
    DataText *data = table->data;
    for (;;) {
        Value value = cell(table);
        if (value.type == VALUE_ERROR || !data_push(data, cells, value))
            return false;
        if (at_line_end(data))
            return true;
        data->at++; /* the separator */
    }
}

static bool keep_row(Table *table, const Values *cells, uint32_t start)
{
    DataText *data = table->data;
    if (table->columns && cells->count != table->columns) {
        const char *message = diag_text(data->e->diags, "a row of %zu cells in a table of %zu",
                                        cells->count, table->columns);
        data_error(data, start, data->at, message)->help =
            "the first row that is read says how many there are; `skip:` leaves rows out before it";
        return false;
    }
    table->columns = cells->count;
    return data_push(data, &table->rows, value_list(data->e, cells->items, cells->count));
}

/* Reads rows of cells, without the first `skip` ones. */
static Value read_text(DataText *data, char separator, uint32_t skip)
{
    Table table = {.data = data, .separator = separator};
    while (!at_end(data)) {
        Values   cells = {0};
        uint32_t start = data->at;
        if (!at_line_end(data) && !read_row(&table, &cells))
            return value_error();
        bool kept = cells.count > 0 && skip == 0;
        skip -= cells.count > 0 && skip > 0;
        if (kept && !keep_row(&table, &cells, start))
            return value_error();
        skip_line_end(data);
    }
    return value_list(data->e, table.rows.items, table.rows.count);
}

/* Returns the separator, a comma unless given; 0: reported. */
static char separator_argument(Elaboration *e, const Call *call)
{
    const Argument *argument = &call->arguments[2];
    if (!argument->syntax)
        return ',';
    Value value = argument->value;
    if (value.type == VALUE_STRING && strlen(value.string) == 1 &&
        !strchr("\"\n\r.+-0123456789", value.string[0]))
        return value.string[0];
    if (value.type == VALUE_STRING) {
        Diag *diag  = diag_add(e->diags, DIAG_BAD_VALUE, argument->syntax->span,
                               "this cannot stand between cells");
        diag->label = "one character is needed, such as `\",\"`, `\";\"` or `\"\\t\"`";
    } else
        type_error(e, argument->syntax, value, "a string");
    return 0;
}

Value builtin_read_csv(Elaboration *e, Call *call)
{
    DataText data;
    uint32_t skip;
    if (!want_count(e, call, 1, 0, MAX_ELEMENTS, 0, &skip))
        return value_error();
    char separator = separator_argument(e, call);
    if (!separator || !data_open(e, call, &data))
        return value_error();
    return read_text(&data, separator, skip);
}
