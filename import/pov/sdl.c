/*
 * sdl.c: POV-Ray's programs: declarations, macros and files that
 * are included.
 *
 * They stand anywhere, also within a vector or an object.  So they are carried
 * out as words are read: pov_advance gives the next word that is left.  What a
 * directive needs to know, such as a condition, is read by those who read
 * values, which asks for words again.
 *
 * `#declare A = B #declare C = A`: behind a value the next word is looked at
 * before the name has it. There a directive waits (IMPORT_WORD_HELD), unless it
 * is the end of a macro, until it is asked for.
 */
#include <stdio.h>
#include <string.h>

#include "import/pov/reader.h"

enum { MAX_WORDS = 10000000, MAX_SOURCES = 100, MAX_NAMES = 100000 };

/* ---- sources of words ---- */

static PovReader *reader_of(WordReader *words) { return words->user; }

static PovSource *top_source(PovReader *reader)
{
    return &reader->sources.items[reader->sources.count - 1];
}

static bool push_source(PovReader *reader, PovSource source, const char *at, unsigned line)
{
    if (reader->sources.count >= MAX_SOURCES)
        return import_refuse(reader->import, reader->words.word.line,
                             "macros and files are more than %d deep in each other", MAX_SOURCES);
    PovSource *outer = reader->sources.count > 0 ? top_source(reader) : NULL;
    if (outer) {
        outer->at   = reader->words.at;
        outer->line = reader->words.line;
        if (outer->fixed_line > 0)
            source.fixed_line = outer->fixed_line; /* all of it counts as where it began */
    }
    array_push(reader->import->arena, &reader->sources, source);
    reader->words.at   = at;
    reader->words.line = source.fixed_line > 0 ? source.fixed_line : line;
    return true;
}

void pov_pop_source(PovReader *reader)
{
    reader->names.count = top_source(reader)->names_before;
    reader->sources.count--;
    reader->words.at   = top_source(reader)->at;
    reader->words.line = top_source(reader)->line;
}

/* Reads the next word of the source, whatever it is; at the end of a file that of
 * the file around it. */
static void raw_word(PovReader *reader)
{
    WordReader *words = &reader->words;
    if (++reader->words_read > MAX_WORDS)
        import_refuse(reader->import, words->word.line, "this program has no end, or a far one");
    for (;;) {
        words_advance_plain(words);
        if (top_source(reader)->fixed_line > 0)
            words->line = words->word.line = top_source(reader)->fixed_line;
        if (words->word.kind != IMPORT_WORD_END || reader->import->refusal.length > 0 ||
            reader->sources.count == 1 || top_source(reader)->macro)
            return;
        pov_pop_source(reader);
    }
}

/* ---- names ---- */

PovCell *pov_find(PovReader *reader, const char *name)
{
    for (size_t i = reader->names.count; i-- > 0;)
        if (reader->names.items[i].name[0] == name[0] &&
            strcmp(reader->names.items[i].name, name) == 0)
            return reader->names.items[i].cell;
    return NULL;
}

PovCell *pov_find_next(PovReader *reader)
{
    const ImportWord *word = &reader->words.word;
    return word->kind == IMPORT_WORD_NAME ? pov_find(reader, word->text) : NULL;
}

/* Names of the innermost macro or file stand last; others are for all. */
static PovCell *new_name(PovReader *reader, const char *name, PovCell *cell, bool local)
{
    PovName fresh = {name, cell};
    if (reader->names.count >= MAX_NAMES) {
        import_refuse(reader->import, reader->words.word.line, "more than %d names are declared",
                      MAX_NAMES);
        return NULL;
    }
    array_push(reader->import->arena, &reader->names, fresh);
    if (local)
        return cell;
    /* The name goes before all that are local, so that it stays when they go. */
    size_t at = reader->names.count - 1;
    size_t to = reader->sources.count > 1 ? reader->sources.items[1].names_before : at;
    for (; at > to; at--)
        reader->names.items[at] = reader->names.items[at - 1];
    reader->names.items[to] = fresh;
    for (size_t i = 1; i < reader->sources.count; i++)
        reader->sources.items[i].names_before++;
    return cell;
}

static PovCell *find_local(PovReader *reader, const char *name)
{
    for (size_t i = reader->names.count; i-- > top_source(reader)->names_before;)
        if (strcmp(reader->names.items[i].name, name) == 0)
            return reader->names.items[i].cell;
    return NULL;
}

/* Returns the cell that a declaration fills. */
PovCell *pov_cell_to_fill(PovReader *reader, const char *name, bool local)
{
    PovCell *cell = local ? find_local(reader, name) : pov_find(reader, name);
    return cell ? cell : new_name(reader, name, arena_new(reader->import->arena, PovCell), local);
}

/* ---- macros ---- */

static bool do_macro(PovReader *reader)
{
    WordReader *words = &reader->words;
    PovMacro   *macro = arena_new(reader->import->arena, PovMacro);
    *macro            = (PovMacro){.fixed_line = top_source(reader)->fixed_line};
    words_advance_plain(words);
    PovCell *cell = pov_cell_to_fill(reader, words->word.text, false);
    words_advance_plain(words);
    if (!cell || !word_is(words, "("))
        return word_refuse(words, "`(`");
    for (words_advance_plain(words); !word_is(words, ")"); words_advance_plain(words)) {
        if (words->word.kind == IMPORT_WORD_NAME)
            array_push(reader->import->arena, &macro->parameters, words->word.text);
        else if (!word_is(words, ","))
            return word_refuse(words, "the name of a parameter");
    }
    macro->at   = words->at;
    macro->line = words->line;
    *cell       = (PovCell){.kind = POV_MACRO, .macro = macro};
    return pov_leave(reader, 1);
}

/* Calls a macro whose name is the word.  Parameters that are names stand for
 * what is named. */
static bool call_macro(PovReader *reader, const PovMacro *macro)
{
    WordReader *words     = &reader->words;
    PovCell   **arguments = arena_new_array(reader->import->arena, PovCell *,
                                            macro->parameters.count + 1);
    int         held      = reader->held_at;
    reader->held_at       = -1;
    words_advance(words);
    if (!word_expect(words, "("))
        return false;
    for (size_t i = 0; i < macro->parameters.count && !word_is(words, ")"); i++) {
        if (!pov_argument(reader, &arguments[i]))
            return false;
        if (i + 1 < macro->parameters.count)
            word_accept(words, ",");
    }
    if (!word_is(words, ")"))
        return word_refuse(words, "`)` behind the parameters of a macro");
    reader->held_at  = held;
    PovSource source = {.macro        = true,
                        .names_before = reader->names.count,
                        .fixed_line   = macro->fixed_line > 0 ? words->word.line : 0};
    if (!push_source(reader, source, macro->at, macro->line))
        return false;
    pov_push_block(reader, (PovBlock){.kind = POV_MACRO_BODY});
    for (size_t i = 0; i < macro->parameters.count; i++)
        if (!new_name(reader, macro->parameters.items[i],
                      arguments[i] ? arguments[i] : arena_new(reader->import->arena, PovCell),
                      true))
            return false;
    return true;
}

/* ---- files ---- */

static bool do_include(PovReader *reader)
{
    WordReader *words = &reader->words;
    words_advance(words);
    PovCell    *own  = pov_find_next(reader);
    const char *name = words->word.kind == IMPORT_WORD_STRING ? words->word.text
                       : own && own->kind == POV_STRING       ? own->string
                                                              : NULL;
    unsigned    line = words->word.line;
    if (!name)
        return word_refuse(words, "the name of a file, between quotes");
    const char *text;
    if (!pov_read_included(reader->import, line, name, &text))
        return false;
    PovSource source = {.names_before = reader->names.count, .fixed_line = line};
    return !text || push_source(reader, source, text, line);
}

/* ---- declarations ---- */

/* Returns a name for the scene.  Names of the language have no capital letters, so others get a
   prefix. */
static const char *scene_name(PovReader *reader, const char *name)
{
    Text text  = {.arena = reader->import->arena};
    bool large = false;
    int  same  = 1;
    for (const char *c = name; *c; c++)
        large = large || (*c >= 'A' && *c <= 'Z');
    for (size_t i = 0; i < reader->shared.count; i++)
        same += strcmp(reader->shared.items[i], name) == 0;
    array_push(reader->import->arena, &reader->shared, name);
    text_format(&text, "%s%s", large && name[0] != '_' ? "" : "my_", name);
    if (same > 1)
        text_format(&text, "_%d_again", same);
    return text.bytes;
}

/* Reads a declared name.  What an included file declares, and cannot be said, is refused where it
   is used.  With --keep-going an object of the file itself that is refused is one of which nothing
   is seen. */
static bool declared(PovReader *reader, PovCell *cell)
{
    const char *behind = reader->words.at + strspn(reader->words.at, " \t\r\n");
    unsigned    line   = reader->words.word.line;
    Import     *import = reader->import;
    PovState    state;
    pov_keep_state(reader, &state);
    if (pov_rvalue(reader, cell))
        return true;
    if (state.word.kind != IMPORT_WORD_NAME || *behind != '{')
        return false;
    *cell = (PovCell){.kind = POV_OBJECT};
    if (state.sources > 1 && import->refusal.length > 0) {
        const char *words = import->refusal.bytes + strlen(import->path) + 1;
        *cell           = (PovCell){.kind = POV_REFUSED, .string = words + strcspn(words, " ") + 1};
        import->refusal = (Text){.arena = import->arena};
    } else if (!import_leaves_out(import, line)) {
        return false;
    }
    pov_restore_state(reader, &state);
    words_advance(&reader->words);
    return pov_skip_block(reader);
}

static bool do_declare(PovReader *reader, bool local, bool *next)
{
    WordReader *words = &reader->words;
    words_advance_plain(words);
    if (word_is(words, "deprecated")) {
        words_advance_plain(words);
        if (word_is(words, "once"))
            words_advance_plain(words);
        if (words->word.kind == IMPORT_WORD_STRING)
            words_advance_plain(words);
    }
    const char *name = words->word.text;
    if (words->word.kind != IMPORT_WORD_NAME)
        return word_refuse(words, "a name");
    PovCell *cell = local ? find_local(reader, name) : pov_find(reader, name), filled = {0};
    int      held = reader->held_at;
    words_advance(words);
    if (word_is(words, "[") && cell && !(cell = pov_element(reader, cell)))
        return false;
    reader->held_at = reader->open;
    bool good       = word_expect(words, "=") && pov_release(reader) && declared(reader, &filled);
    reader->held_at = held;
    if (!good)
        return false;
    if (filled.kind == POV_OBJECT && filled.part && !filled.part->wanted && !filled.part->shared) {
        filled.part->wanted = scene_name(reader, name);
        filled.part->shared = true;
    }
    if (!cell && !(cell = pov_cell_to_fill(reader, name, local)))
        return false;
    *cell = filled;
    *next = !word_is(words, ";");
    return true;
}

/* ---- directives ---- */

/* Reads over words for people, and over what changes no shape. */
static bool do_words(PovReader *reader, PovCell *said, bool *next)
{
    words_advance(&reader->words);
    int held        = reader->held_at;
    reader->held_at = reader->open;
    bool good       = pov_rvalue(reader, said);
    reader->held_at = held;
    *next           = !word_is(&reader->words, ";");
    return good;
}

/* Reads the version; that of included files is their own. */
static bool do_version(PovReader *reader, bool *next)
{
    PovCell said = {0};
    bool    own  = reader->sources.count == 1 && reader->version == 0;
    if (!do_words(reader, &said, next))
        return false;
    if (own && said.kind == POV_VALUE)
        reader->version = said.value.v[0];
    return true;
}

/* Ignores files: nothing is written; what a program reads from files is not known. */
static bool do_file(PovReader *reader, const char *name, bool *next)
{
    WordReader *words = &reader->words;
    unsigned    line  = words->word.line;
    int         open  = 0;
    const char *path;
    words_advance_plain(words);
    if (strcmp(name, "fclose") == 0)
        return true;
    if (strcmp(name, "fopen") == 0) {
        words_advance(words);
        if (!pov_string(reader, &path))
            return false;
        if (word_is(words, "read"))
            return import_refuse(reader->import, line, "`#fopen` to read is not translated");
        import_note(reader->import, line, "no files are written");
        return word_is(words, "write") || word_is(words, "append") || (*next = true);
    }
    do {
        open += word_is(words, "(") ? 1 : word_is(words, ")") ? -1 : 0;
        if (open > 0)
            words_advance_plain(words);
    } while (open > 0 && words->word.kind != IMPORT_WORD_END);
    return true;
}

static bool do_undef(PovReader *reader)
{
    words_advance_plain(&reader->words);
    for (size_t i = reader->names.count; i-- > 0;)
        if (strcmp(reader->names.items[i].name, reader->words.word.text) == 0) {
            reader->names.items[i].name = "";
            break;
        }
    return true;
}

bool pov_default(PovReader *reader)
{
    bool taken = false;
    words_advance(&reader->words);
    if (!word_expect(&reader->words, "{"))
        return false;
    while (!word_is(&reader->words, "}")) {
        taken = false;
        if (!pov_look(reader, &reader->usual, &taken))
            return false;
        if (!taken && !pov_leave_out(reader, "of `#default` is"))
            return false;
    }
    reader->usual.said = reader->usual.textured = false;
    return true;
}

/* Carries out a directive, whose name is the word.  *next: the word behind it
 * is read already. */
static bool directive(PovReader *reader, bool *next)
{
    WordReader *words = &reader->words;
    const char *name  = words->word.text;
    unsigned    line  = words->word.line;
    *next             = false;
    if (strcmp(name, "declare") == 0 || strcmp(name, "local") == 0)
        return do_declare(reader, strcmp(name, "local") == 0, next);
    bool taken, good = pov_block_directive(reader, name, &taken);
    if (taken)
        return good;
    if (strcmp(name, "macro") == 0)
        return do_macro(reader);
    if (strcmp(name, "include") == 0)
        return do_include(reader);
    if (strcmp(name, "fopen") == 0 || strcmp(name, "fclose") == 0 || strcmp(name, "write") == 0)
        return do_file(reader, name, next);
    if (strcmp(name, "undef") == 0)
        return do_undef(reader);
    if (strcmp(name, "default") == 0)
        return pov_default(reader);
    if (strcmp(name, "debug") == 0 || strcmp(name, "warning") == 0 || strcmp(name, "render") == 0 ||
        strcmp(name, "statistics") == 0)
        return do_words(reader, &(PovCell){0}, next);
    if (strcmp(name, "version") == 0)
        return do_version(reader, next);
    if (strcmp(name, "error") == 0) {
        PovCell said = {0};
        words_advance(words);
        return pov_rvalue(reader, &said) &&
               import_refuse(reader->import, line, "the file says: %.100s",
                             said.kind == POV_STRING ? said.string : "an error");
    }
    return import_refuse(reader->import, line, "`#%.40s` is not translated", name);
}

/* ---- the next word ---- */

/* Carries out what stands at the word, if it is a directive or calls a macro;
 * false: it is neither. */
static bool carry_out(PovReader *reader, bool *next)
{
    WordReader *words = &reader->words;
    *next             = false;
    if (word_is(words, "#")) {
        words_advance_plain(words);
        bool ends = word_is(words, "end") && pov_top_block(reader) &&
                    pov_top_block(reader)->kind == POV_MACRO_BODY;
        if (!ends && reader->held_at == reader->open) {
            words->word.kind = IMPORT_WORD_HELD;
            return *next     = true;
        }
        directive(reader, next);
        return true;
    }
    PovCell *own = pov_find_next(reader);
    if (!own || own->kind != POV_MACRO)
        return false;
    if (reader->held_at == reader->open) {
        words->word.kind = IMPORT_WORD_HELD;
        return *next     = true;
    }
    call_macro(reader, own->macro);
    return true;
}

static void settle(PovReader *reader, bool next)
{
    WordReader *words = &reader->words;
    while (reader->import->refusal.length == 0) {
        if (!next)
            raw_word(reader);
        next = false;
        if (words->word.kind == IMPORT_WORD_HELD && reader->held_at != reader->open) {
            pov_release(reader);
            return;
        }
        if (words->word.kind == IMPORT_WORD_HELD || !carry_out(reader, &next))
            break;
        if (next && words->word.kind != IMPORT_WORD_HELD)
            return; /* it is settled already */
    }
    if (reader->import->refusal.length > 0)
        words->word = (ImportWord){.kind = IMPORT_WORD_END, .text = "", .line = words->word.line};
    if (words->word.kind == IMPORT_WORD_SIGN && words->word.text[1] == '\0')
        reader->open += strchr("{([", words->word.text[0])   ? 1
                        : strchr("})]", words->word.text[0]) ? -1
                                                             : 0;
}

static void next_word(WordReader *words) { settle(reader_of(words), false); }

bool pov_release(PovReader *reader)
{
    WordReader *words = &reader->words;
    bool        next  = false;
    int         held  = reader->held_at;
    if (words->word.kind != IMPORT_WORD_HELD)
        return true;
    reader->held_at = -1;
    PovCell *own    = pov_find(reader, words->word.text);
    if (own && own->kind == POV_MACRO)
        call_macro(reader, own->macro);
    else
        directive(reader, &next);
    reader->held_at = held;
    if (!next)
        settle(reader, false);
    return reader->import->refusal.length == 0 && pov_release(reader);
}

void pov_start(PovReader *reader)
{
    PovSource file  = {.names_before = 0};
    reader->held_at = -1;
    reader->words   = (WordReader){.import = reader->import,
                                   .at     = reader->import->bytes,
                                   .line   = 1,
                                   .nested = true,
                                   .user   = reader,
                                   .next   = next_word};
    array_push(reader->import->arena, &reader->sources, file);
    words_advance(&reader->words);
}

void pov_keep_state(PovReader *reader, PovState *state)
{
    *state = (PovState){reader->words.word,    reader->words.at,     reader->words.line,
                        reader->depth,         reader->open,         reader->held_at,
                        reader->sources.count, reader->blocks.count, *top_source(reader)};
}

void pov_restore_state(PovReader *reader, const PovState *state)
{
    reader->words.word    = state->word;
    reader->words.at      = state->at;
    reader->words.line    = state->line;
    reader->depth         = state->depth;
    reader->open          = state->open;
    reader->held_at       = state->held_at;
    reader->sources.count = state->sources;
    reader->blocks.count  = state->blocks;
    *top_source(reader)   = state->top;
}

/* ---- functions ---- */

/* Reads the formula of a function again, with its parameters as names. */
bool pov_evaluate(PovReader *reader, const PovMacro *function, const double *numbers,
                  PovValue *value)
{
    WordReader *words = &reader->words;
    ImportWord  word  = words->word;
    size_t      names = reader->names.count;
    int         held = reader->held_at, open = reader->open;
    PovSource   source = {.names_before = names, .fixed_line = words->word.line};
    if (!pov_deeper(reader) || !push_source(reader, source, function->at, function->line))
        return false;
    for (size_t i = 0; i < function->parameters.count; i++) {
        PovCell *cell = arena_new(reader->import->arena, PovCell);
        *cell         = (PovCell){.kind = POV_VALUE, .value = {.v = {numbers[i]}, .count = 1}};
        new_name(reader, function->parameters.items[i], cell, true);
    }
    reader->held_at = -1;
    words_advance(words);
    bool good = pov_condition(reader, value) && (word_is(words, "}") || word_refuse(words, "`}`"));
    reader->depth--;
    if (!good)
        return false;
    pov_pop_source(reader);
    reader->names.count = names;
    reader->held_at     = held;
    reader->open        = open;
    words->word         = word;
    return true;
}
