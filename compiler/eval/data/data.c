/*
 * data.c: what `read_csv` and `read_json` have in common.
 */
#include "compiler/eval/data/data.h"

#include <math.h>
#include <string.h>

static bool is_digit(char c) { return c >= '0' && c <= '9'; }

/* ---- mistakes ---- */

Diag *data_error(DataText *data, uint32_t start, uint32_t end, const char *message)
{
    Diags *diags = data->e->diags;
    Diag  *diag  = diag_add(diags, DIAG_BAD_DATA, (Span){data->source, start, end}, "%s", message);
    diag_secondary(diags, diag, data->call->span, "read here");
    return diag;
}

bool data_push(DataText *data, Values *values, Value value)
{
    if (++data->values > MAX_ELEMENTS) {
        Diag *diag  = diag_add(data->e->diags, DIAG_LIMIT, data->call->span,
                               "a file of more than 4 million values");
        diag->label = "read here";
        return false;
    }
    array_push_large(data->e->arena, values, value);
    return true;
}

/* ---- numbers and strings ---- */

static uint32_t skip_digits(const DataText *data, uint32_t at)
{
    while (is_digit(data->text[at]))
        at++;
    return at;
}

/* Returns where an exponent that begins at a place ends; the same place without one. */
static uint32_t skip_exponent(const DataText *data, uint32_t at)
{
    uint32_t sign = data->text[at] == 'e' || data->text[at] == 'E' ? at + 1 : at;
    if (sign == at)
        return at;
    uint32_t digits = sign + (data->text[sign] == '-' || data->text[sign] == '+');
    uint32_t end    = skip_digits(data, digits);
    return end > digits ? end : at;
}

uint32_t data_number_length(const DataText *data, uint32_t start, bool strict)
{
    const char *text  = data->text;
    uint32_t    whole = start + (text[start] == '-' || (!strict && text[start] == '+'));
    uint32_t    end   = skip_digits(data, whole);
    uint32_t    count = end - whole, behind = 0;
    if (strict && count > 1 && text[whole] == '0')
        return 0;
    if (text[end] == '.') {
        uint32_t last = skip_digits(data, end + 1);
        behind        = last - end - 1;
        if (behind > 0 || !strict)
            end = last;
    }
    if (strict ? count == 0 : count + behind == 0)
        return 0;
    return skip_exponent(data, end) - start;
}

Value data_number(DataText *data, uint32_t start, uint32_t end)
{
    bool     minus = data->text[start] == '-', sign = minus || data->text[start] == '+';
    uint32_t first  = start + sign;
    double   number = text_decimal(data->text + first, end - first);
    if (isinf(number)) {
        data_error(data, start, end, "a number that is too large")->help =
            "the largest is about 1.8e308";
        return value_error();
    }
    return value_authored(data->e, value_number(minus ? -number : number));
}

Value data_string(DataText *data, uint32_t start, uint32_t end)
{
    const Text *text = &data->scratch;
    uint32_t    character;
    for (size_t i = 0, used; i < text->length; i += used) {
        used = text_character(text->bytes + i, text->length - i, &character);
        if (used > 0 && character != 0)
            continue;
        data_error(data, start, end,
                   used ? "a text with a character 0" : "a text that is not UTF-8");
        return value_error();
    }
    return value_string(data->e, text->bytes, text->length);
}

/* ---- calls ---- */

bool data_open(Elaboration *e, const Call *call, DataText *data)
{
    const Argument *path = &call->arguments[0];
    if (path->value.type != VALUE_STRING) {
        type_error(e, path->syntax, path->value, "the name of a file, a string");
        return false;
    }
    uint32_t from   = call->syntax->span.source;
    uint32_t source = files_load_data(e->files, from, path->value.string, path->syntax->span);
    if (!source)
        return false;
    const Source *file = &e->sources->items[source];
    *data              = (DataText){.e       = e,
                                    .call    = call->syntax,
                                    .text    = file->text,
                                    .source  = source,
                                    .length  = file->length,
                                    .at      = file->lines[0], /* behind a byte order mark */
                                    .scratch = {.arena = e->scratch}};
    return count_steps(e, file->length, call->syntax->span);
}
