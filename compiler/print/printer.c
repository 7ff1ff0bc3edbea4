/*
 * printer.c: languages that are nearly others.
 */
#include "compiler/print/printer.h"

#include <string.h>

static const char *const *merge_templates(const char *const *own, const char *const *base,
                                          Arena *arena)
{
    const char **merged = arena_new_array(arena, const char *, TEMPLATE_COUNT);
    for (int i = 0; i < TEMPLATE_COUNT; i++)
        merged[i] = own && own[i] ? own[i] : base[i];
    return merged;
}

Printer printer_with_base(const Printer *printer, Arena *arena)
{
    Printer whole = *printer;
    if (!printer->base)
        return whole;
    const Printer base = printer_with_base(printer->base, arena);
    whole.types        = whole.types ? whole.types : base.types;
    whole.alternatives = whole.alternatives ? whole.alternatives : base.alternatives;
    whole.templates    = merge_templates(whole.templates, base.templates, arena);
    return whole;
}

const char *printer_operation(const Printer *printer, Op op, GraphType type, Arena *arena)
{
    Text        spelled = {.arena = arena};
    const char *words   = printer->operation ? printer->operation(op, type) : NULL;
    if (words || !printer->base)
        return words;
    words = printer_operation(printer->base, op, type, arena);
    if (!words || !printer->spell)
        return words;
    printer->spell(words, strlen(words), type, &spelled);
    return spelled.bytes;
}
