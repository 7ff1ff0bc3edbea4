/*
 * blocks.c: conditions and loops of POV-Ray's programs, and what is skipped of them.
 */
#include <math.h>
#include <string.h>

#include "import/pov/reader.h"

/* ---- skipping ---- */

static bool opens_block(const char *name)
{
    static const char *const openers[] = {"if",  "ifdef",  "ifndef", "while",
                                          "for", "switch", "macro"};
    for (size_t i = 0; i < sizeof openers / sizeof *openers; i++)
        if (strcmp(openers[i], name) == 0)
            return true;
    return false;
}

/* Skips to a directive of the same level that is one of these; its name is then
   the word.  `depth`: how many blocks are to be left. */
static bool skip_to(PovReader *reader, const char *const *names, int depth)
{
    WordReader *words = &reader->words;
    unsigned    line  = words->word.line;
    while (words->word.kind != IMPORT_WORD_END || words->at[0] != '\0') {
        words_advance_plain(words);
        if (reader->import->refusal.length > 0)
            return false;
        if (!word_is(words, "#"))
            continue;
        words_advance_plain(words);
        if (words->word.kind != IMPORT_WORD_NAME)
            continue;
        for (int i = 0; depth == 1 && names[i]; i++)
            if (word_is(words, names[i]))
                return true;
        if (opens_block(words->word.text))
            depth++;
        else if (word_is(words, "end"))
            depth--;
        if (depth == 0)
            return true;
    }
    return import_refuse(reader->import, line, "there is no `#end` for this");
}

/* ---- conditions and loops ---- */

PovBlock *pov_top_block(PovReader *reader)
{
    return reader->blocks.count > 0 ? &reader->blocks.items[reader->blocks.count - 1] : NULL;
}

void pov_push_block(PovReader *reader, PovBlock block)
{
    block.source = reader->sources.count;
    block.line   = reader->words.word.line;
    array_push(reader->import->arena, &reader->blocks, block);
}

/* Reads a value between parentheses.  The last one is the word then, so that reading may go on
   elsewhere. */
static bool read_condition(PovReader *reader, double *number)
{
    WordReader *words = &reader->words;
    PovValue    value;
    words_advance(words);
    if (!word_expect(words, "(") || !pov_condition(reader, &value))
        return false;
    *number = value.v[0];
    return word_is(words, ")") || word_refuse(words, "`)`");
}

/* Goes on behind a condition that does not hold: at `#else`, at an `#elseif`
 * that holds, or at the end. */
static bool skip_to_else(PovReader *reader)
{
    static const char *const names[] = {"else", "elseif", NULL};
    while (skip_to(reader, names, 1)) {
        double holds = 1;
        if (word_is(&reader->words, "end"))
            return true;
        if (word_is(&reader->words, "elseif") && !read_condition(reader, &holds))
            return false;
        if (holds == 0)
            continue;
        pov_push_block(reader, (PovBlock){.kind = POV_IF});
        return true;
    }
    return false;
}

/* Tells whether a name between parentheses, with its indices, stands for anything. */
static bool read_defined(PovReader *reader, double *defined)
{
    WordReader *words = &reader->words;
    words_advance(words);
    if (!word_is(words, "("))
        return word_refuse(words, "`(`");
    words_advance_plain(words); /* a macro is not called */
    PovCell *cell = pov_find(reader, words->word.text);
    words_advance(words);
    if (cell && word_is(words, "[") && !(cell = pov_element(reader, cell)))
        return false;
    *defined = cell && cell->kind != POV_NOTHING;
    return word_is(words, ")") || word_refuse(words, "`)`");
}

static bool do_if(PovReader *reader, const char *name)
{
    double holds = 0;
    if (strcmp(name, "if") == 0) {
        if (!read_condition(reader, &holds))
            return false;
    } else if (!read_defined(reader, &holds)) {
        return false;
    } else {
        holds = holds == (strcmp(name, "ifdef") == 0);
    }
    if (holds == 0)
        return skip_to_else(reader);
    pov_push_block(reader, (PovBlock){.kind = POV_IF});
    return true;
}

bool pov_leave(PovReader *reader, int depth)
{
    static const char *const none[] = {NULL};
    return skip_to(reader, none, depth);
}

static bool do_while(PovReader *reader)
{
    PovBlock block = {.kind = POV_WHILE, .at = reader->words.at, .at_line = reader->words.line};
    double   holds;
    if (!read_condition(reader, &holds))
        return false;
    if (holds == 0)
        return pov_leave(reader, 1);
    pov_push_block(reader, block);
    return true;
}

static bool goes_on(const PovBlock *block, double number)
{
    const double SLACK = 1e-10;
    return block->step > 0 ? number <= block->last + SLACK : number >= block->last - SLACK;
}

static bool do_for(PovReader *reader)
{
    WordReader *words      = &reader->words;
    double      numbers[3] = {0, 0, 1};
    words_advance(words);
    if (!word_is(words, "("))
        return word_refuse(words, "`(`");
    words_advance_plain(words);
    PovBlock block = {.kind = POV_FOR, .cell = pov_cell_to_fill(reader, words->word.text, true)};
    if (!block.cell)
        return false;
    words_advance(words);
    for (int i = 0; i < 3 && word_accept(words, ","); i++)
        if (!pov_number(reader, &numbers[i]))
            return false;
    if (!word_is(words, ")") || numbers[2] == 0)
        return word_refuse(words, "`)`, behind a step that is not 0");
    block.cell->kind  = POV_VALUE;
    block.cell->value = (PovValue){.v = {numbers[0]}, .count = 1};
    block.last        = numbers[1];
    block.step        = numbers[2];
    block.at          = words->at;
    block.at_line     = words->line;
    if (!goes_on(&block, numbers[0]))
        return pov_leave(reader, 1);
    pov_push_block(reader, block);
    return true;
}

static bool is_case(PovReader *reader, double value, bool *found)
{
    WordReader *words = &reader->words;
    PovValue    low, high;
    bool        range = word_is(words, "range");
    words_advance(words);
    if (!word_expect(words, "(") || !pov_condition(reader, &low))
        return false;
    high = low;
    if (range && (!word_expect(words, ",") || !pov_condition(reader, &high)))
        return false;
    *found = value >= low.v[0] - 1e-10 && value <= high.v[0] + 1e-10;
    return word_is(words, ")") || word_refuse(words, "`)`");
}

static bool do_switch(PovReader *reader)
{
    static const char *const names[] = {"case", "range", "else", NULL};
    double                   value;
    if (!read_condition(reader, &value))
        return false;
    while (skip_to(reader, names, 1)) {
        bool found = word_is(&reader->words, "else");
        if (word_is(&reader->words, "end"))
            return true;
        if (!found && !is_case(reader, value, &found))
            return false;
        if (!found)
            continue;
        pov_push_block(reader, (PovBlock){.kind = POV_SWITCH});
        return true;
    }
    return false;
}

/* Leaves the innermost loop or `#switch`. */
static bool do_break(PovReader *reader)
{
    int depth = 1;
    for (; reader->blocks.count > 0 && pov_top_block(reader)->kind == POV_IF; depth++)
        reader->blocks.count--;
    if (reader->blocks.count == 0 || pov_top_block(reader)->kind == POV_MACRO_BODY)
        return import_refuse(reader->import, reader->words.word.line, "`#break` of nothing");
    reader->blocks.count--;
    return pov_leave(reader, depth);
}

static bool do_end(PovReader *reader)
{
    PovBlock *block = pov_top_block(reader);
    double    holds;
    if (!block || block->source != reader->sources.count)
        return import_refuse(reader->import, reader->words.word.line, "`#end` of nothing");
    if (block->kind == POV_WHILE) {
        PovBlock again     = *block;
        reader->words.at   = again.at;
        reader->words.line = again.at_line;
        reader->blocks.count--;
        if (!read_condition(reader, &holds))
            return false;
        if (holds == 0)
            return pov_leave(reader, 1);
        array_push(reader->import->arena, &reader->blocks, again);
        return true;
    }
    if (block->kind == POV_FOR) {
        block->cell->value.v[0] += block->step;
        if (goes_on(block, block->cell->value.v[0])) {
            reader->words.at   = block->at;
            reader->words.line = block->at_line;
            return true;
        }
    }
    bool macro = block->kind == POV_MACRO_BODY;
    reader->blocks.count--;
    if (macro)
        pov_pop_source(reader);
    return true;
}

/* Takes `#else` where what stands before it was carried out. */
static bool do_else(PovReader *reader)
{
    PovBlock *block = pov_top_block(reader);
    if (!block || (block->kind != POV_IF && block->kind != POV_SWITCH))
        return import_refuse(reader->import, reader->words.word.line, "`#else` of nothing");
    if (block->kind == POV_SWITCH)
        return true;
    reader->blocks.count--;
    return pov_leave(reader, 1);
}

bool pov_block_directive(PovReader *reader, const char *name, bool *taken)
{
    *taken = true;
    if (strcmp(name, "if") == 0 || strcmp(name, "ifdef") == 0 || strcmp(name, "ifndef") == 0)
        return do_if(reader, name);
    if (strcmp(name, "else") == 0 || strcmp(name, "elseif") == 0)
        return do_else(reader);
    if (strcmp(name, "end") == 0)
        return do_end(reader);
    if (strcmp(name, "while") == 0)
        return do_while(reader);
    if (strcmp(name, "for") == 0)
        return do_for(reader);
    if (strcmp(name, "switch") == 0)
        return do_switch(reader);
    if (strcmp(name, "case") == 0 || strcmp(name, "range") == 0)
        return is_case(reader, 0, &(bool){false});
    if (strcmp(name, "break") == 0)
        return do_break(reader);
    *taken = false;
    return true;
}
