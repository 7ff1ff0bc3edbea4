/*
 * diag.c: collects diagnostics and writes them as JSON.  diag_text.c writes them for people.
 */
#include "compiler/base/diag.h"

#include <string.h>

#include "compiler/base/json.h"

#define SEVERITY_ERROR   DIAG_ERROR
#define SEVERITY_WARNING DIAG_WARNING
#define SEVERITY_NOTE    DIAG_NOTE

const DiagInfo diag_info[DIAG_CODE_COUNT] = {
#define DIAG(code, severity, name, title, explanation) [DIAG_##name] = {#code, SEVERITY_##severity},
#include "compiler/base/diag.def"
#undef DIAG
};

const DiagInfo *diag_find(const char *code)
{
    for (size_t i = 0; i < DIAG_CODE_COUNT; i++)
        if (strcmp(diag_info[i].code, code) == 0)
            return &diag_info[i];
    return NULL;
}

const char *diag_severity(DiagCode code)
{
    static const char *const names[] = {
        [DIAG_ERROR] = "error", [DIAG_WARNING] = "warning", [DIAG_NOTE] = "note"};
    return names[diag_info[code].severity];
}

static bool is_note(const Diag *diag) { return diag_info[diag->code].severity == DIAG_NOTE; }

/* ---- collecting ---- */

static bool same_span(Span a, Span b)
{
    return a.source == b.source && a.start == b.start && a.end == b.end;
}

/* Tells whether a diagnostic was given before.  The statements of a loop are elaborated many times and
   would report the same mistake each time.  Only stored diagnostics are compared, which are few.
   A diagnostic without a location is never a repeat. */
static bool is_repeat(const Diags *diags, DiagCode code, Span span)
{
    for (size_t i = 0; i < diags->count && span.source != 0; i++)
        if (diags->items[i]->code == code && same_span(diags->items[i]->span, span))
            return true;
    return false;
}

bool diags_full(const Diags *diags) { return diags->errors > MAX_DIAGS; }

static Diag *diag_new(Diags *diags, DiagCode code, Span span)
{
    DiagSeverity severity = diag_info[code].severity;
    bool         retained = severity == DIAG_NOTE;
    if (!retained && !is_repeat(diags, code, span)) {
        size_t *count = severity == DIAG_ERROR ? &diags->errors : &diags->warnings;
        retained      = ++*count <= MAX_DIAGS;
    }
    Diag *diag = retained ? arena_new(diags->arena, Diag) : &diags->scrap;
    *diag      = (Diag){.code = code, .span = span, .message = ""};
    if (retained)
        array_push(diags->arena, diags, diag);
    return diag;
}

Diag *diag_add(Diags *diags, DiagCode code, Span span, const char *format, ...)
{
    Diag *diag = diag_new(diags, code, span);
    if (diag != &diags->scrap) {
        Text    message = {.arena = diags->arena};
        va_list arguments;
        va_start(arguments, format);
        text_format_list(&message, format, arguments);
        va_end(arguments);
        diag->message = message.bytes;
    }
    return diag;
}

const char *diag_text(Diags *diags, const char *format, ...)
{
    Text    text = {.arena = diags->arena};
    va_list arguments;
    va_start(arguments, format);
    text_format_list(&text, format, arguments);
    va_end(arguments);
    return text.bytes;
}

void diag_note(Diags *diags, Diag *diag, const char *note)
{
    if (diag != &diags->scrap)
        array_push(diags->arena, &diag->notes, note);
}

void diag_secondary(Diags *diags, Diag *diag, Span span, const char *label)
{
    SecondarySpan secondary = {span, label};
    if (diag != &diags->scrap)
        array_push(diags->arena, &diag->secondary, secondary);
}

/* ---- order ---- */

static bool comes_after(const Diag *a, const Diag *b)
{
    if (is_note(a) || is_note(b))
        return !is_note(a);
    if (a->span.source != b->span.source)
        return a->span.source > b->span.source;
    if (a->span.start != b->span.start)
        return a->span.start > b->span.start;
    return a->span.end > b->span.end;
}

/* Sorts by insertion: there are some 40 diagnostics and 100 notes at most, and those at one place
   must keep their order. */
void diags_sort(Diags *diags)
{
    for (size_t i = 1; i < diags->count; i++) {
        Diag  *diag = diags->items[i];
        size_t at   = i;
        for (; at > 0 && comes_after(diags->items[at - 1], diag); at--)
            diags->items[at] = diags->items[at - 1];
        diags->items[at] = diag;
    }
}

/* ---- JSON ---- */

static void json_position(Json *json, const char *name, const Source *source, uint32_t offset)
{
    const Utf16Position at = source ? source_utf16_position(source, offset) : (Utf16Position){0};
    json_open(json, name, "{");
    json_whole(json, "line", at.line);
    json_whole(json, "character", at.character);
    json_close(json, "}");
}

void diag_json_range(Json *json, const char *name, const Source *source, uint32_t start,
                     uint32_t end)
{
    json_open(json, name, "{");
    json_position(json, "start", source, start);
    json_position(json, "end", source, end);
    json_close(json, "}");
}

static void json_location(const Diags *diags, Span span, Json *json)
{
    const Source *source = span.source ? &diags->sources->items[span.source] : NULL;
    json_text(json, "uri", source ? source->name : "");
    diag_json_range(json, "range", source, span.start, span.end);
}

static void json_related(const Diags *diags, const Diag *diag, Json *json)
{
    json_open(json, "relatedInformation", "[");
    for (size_t i = 0; i < diag->secondary.count; i++) {
        const char *label = diag->secondary.items[i].label;
        json_open(json, NULL, "{");
        json_open(json, "location", "{");
        json_location(diags, diag->secondary.items[i].span, json);
        json_close(json, "}");
        json_text(json, "message", label ? label : "");
        json_close(json, "}");
    }
    json_close(json, "]");
}

/* The Language Server Protocol has no fields for these values.  It leaves `data` to each server. */
static void json_data(const Diag *diag, Json *json)
{
    json_open(json, "data", "{");
    if (diag->label)
        json_text(json, "label", diag->label);
    if (diag->help)
        json_text(json, "help", diag->help);
    if (diag->replacement)
        json_text(json, "replacement", diag->replacement);
    json_open(json, "notes", "[");
    for (size_t i = 0; i < diag->notes.count; i++)
        json_text(json, NULL, diag->notes.items[i]);
    json_close(json, "]");
    json_close(json, "}");
}

void diag_json_one(const Diags *diags, const Diag *diag, Text *out)
{
    const DiagInfo *info = &diag_info[diag->code];
    Json            json = {.text = *out};
    json_open(&json, NULL, "{");
    json_location(diags, diag->span, &json);
    json_whole(&json, "severity", (uint64_t)info->severity + 1);
    json_text(&json, "code", info->code);
    json_text(&json, "source", "krs");
    json_text(&json, "message", diag->message);
    json_related(diags, diag, &json);
    json_data(diag, &json);
    json_close(&json, "}");
    *out = json.text;
}

void diags_print_json(const Diags *diags, Text *out)
{
    for (size_t i = 0; i < diags->count; i++) {
        diag_json_one(diags, diags->items[i], out);
        text_add(out, "\n");
    }
}
