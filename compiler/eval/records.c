/*
 * records.c: values with names, as JSON has them: `city.name`, `city["first name"]`.
 */
#include "compiler/eval/elaborate.h"

Value value_record(Elaboration *e, const Value *names, const Value *values, size_t count)
{
    Record *record = arena_new(e->arena, Record);
    *record        = (Record){count, names, values};
    return (Value){.type = VALUE_RECORD, .record = record};
}

Value record_member(Elaboration *e, const Record *record, const char *name, Span span)
{
    for (size_t i = 0; i < record->count; i++)
        if (record->names[i].string == name)
            return record->values[i];
    const char **names = arena_new_array(e->diags->arena, const char *, record->count + 1);
    for (size_t i = 0; i < record->count; i++)
        names[i] = record->names[i].string;
    Diag *diag  = diag_add(e->diags, DIAG_UNKNOWN_PROPERTY, span, "the record has no member `%s`",
                           name);
    diag->label = "unknown member";
    diag->help  = nearest_name(name, names, record->count);
    if (diag->help)
        diag->help = diag_text(e->diags, "a member with a similar name exists: `%s`", diag->help);
    note_names(e, diag, "its members", names, record->count);
    return value_error();
}
