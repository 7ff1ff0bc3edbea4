/*
 * printer.c: languages that are nearly others.
 */
#include "compiler/print/printer.h"

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
    whole.operation    = whole.operation ? whole.operation : base.operation;
    whole.alternatives = whole.alternatives ? whole.alternatives : base.alternatives;
    whole.templates    = merge_templates(whole.templates, base.templates, arena);
    return whole;
}
