/*
 * front_fuzz.c: any bytes through lexer, parser and names, for libFuzzer.
 *
 * Whatever the text, reading it ends; nothing is touched that should not be; every place in the
 * tree and in the diagnostics is within the text; and a tree with a gap in it never comes
 * without an error.  The canonical layout of a text without mistakes is the layout of itself.
 */
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/front/format.h"
#include "compiler/front/names.h"
#include "compiler/front/parse.h"

/* abort() is what libFuzzer takes for a finding. */
static void demand(bool holds)
{
    if (!holds)
        abort();
}

static void check_span(Span span, size_t size)
{
    demand(span.source <= 1 && span.start <= span.end && span.end <= size);
}

/* Returns whether there is a SYNTAX_ERROR. */
static bool check_tree(const Syntax *syntax, size_t size)
{
    bool error = syntax->kind == SYNTAX_ERROR;
    check_span(syntax->span, size);
    check_span(syntax->name_span, size);
    for (uint32_t i = 0; i < syntax->count; i++) {
        demand(syntax->children[i] != NULL && syntax->children[i]->height < syntax->height);
        error = check_tree(syntax->children[i], size) || error;
    }
    return error;
}

static void check_diags(const Diags *diags, size_t size, Arena *arena)
{
    for (size_t i = 0; i < diags->count; i++) {
        check_span(diags->items[i]->span, size);
        for (size_t k = 0; k < diags->items[i]->secondary.count; k++)
            check_span(diags->items[i]->secondary.items[k].span, size);
    }
    Text text = {.arena = arena};
    diags_print_text(diags, true, &text);
    diags_print_json(diags, &text);
}

static void read_scene(const char *bytes, size_t size, Arena *arena)
{
    static const KnownName known[] = {{"x", NULL},    {"y", NULL},      {"z", NULL},
                                      {"p", NULL},    {"u", NULL},      {"v", NULL},
                                      {"time", NULL}, {"sphere", NULL}, {"plane", NULL}};
    NameScope              scope   = {.known = known, .known_count = sizeof known / sizeof *known};
    Sources                sources = {.arena = arena};
    Names                  names   = {.arena = arena};
    Diags                  diags   = {.arena = arena, .sources = &sources};
    NameUses               uses    = {0};
    uint32_t               source  = source_add(&sources, "fuzz.krs", bytes, size, false);
    Tokens                 tokens  = lex(source, &sources, &names, &diags, arena);
    Syntax                *file    = parse(&tokens, &diags, arena);
    bool                   gap     = check_tree(file, size);
    demand(!gap || diags.errors > 0);
    Text layout = {.arena = arena}, again = {.arena = arena};
    if (diags.errors == 0) {
        demand(format_source(source, &sources, arena, &layout));
        uint32_t written = source_add(&sources, "", layout.length ? layout.bytes : "",
                                      layout.length, false);
        demand(format_source(written, &sources, arena, &again) && again.length == layout.length &&
               (again.length == 0 || memcmp(again.bytes, layout.bytes, again.length) == 0));
    }
    names_check(file, &scope, &diags, arena, &uses, arena);
    for (size_t i = 0; i < uses.count; i++)
        check_span(uses.items[i].span, size);
    diags_sort(&diags);
    check_diags(&diags, size, arena);
    Text text = {.arena = arena};
    if (size < 4096) { /* positions are counted from the start of the line */
        tokens_print(&tokens, &sources, &text);
        syntax_print(file, &sources, &text);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    jmp_buf exhausted;
    Memory  memory = {.exhausted = &exhausted, .limit = (size_t)1 << 28};
    Arena   arena  = {.memory = &memory};
    if (setjmp(exhausted) == 0)
        read_scene((const char *)bytes, size, &arena);
    arena_free(&arena);
    demand(memory.used == 0);
    return 0;
}
