/*
 * questions.c: opens and closes texts, and hands questions to who answers.
 */
#include "compiler/service/service.h"

#include <stdlib.h>
#include <string.h>

#include "compiler/base/paths.h"
#include "compiler/passes/compile.h"
#include "compiler/service/analysis.h"

/* ---- the service ---- */

Service *service_new(const ServiceHost *host)
{
    Service *s = calloc(1, sizeof *s);
    if (!s)
        return NULL;
    if (host)
        s->host = *host;
    s->memory = (Memory){.limit = KRS_USUAL_MEMORY};
    s->arena = s->values = s->scratch = (Arena){.memory = &s->memory};
    return s;
}

/* Forgets what was read: any text may use the one that changed. */
void service_forget(Service *service)
{
    for (Document *document = service->documents; document; document = document->next)
        analysis_free(&document->analysis);
}

/* Forgets what the last answer needed. */
static void begin(Service *service)
{
    analysis_free(&service->probe);
    documents_free(&service->neighbours);
    arena_free(&service->arena);
    arena_free(&service->values);
    arena_free(&service->scratch);
    service->json    = (Json){.text = {.arena = &service->arena}};
    service->refusal = NULL;
    service->probed  = NULL;
}

void service_free(Service *service)
{
    if (!service)
        return;
    begin(service);
    documents_free(&service->documents);
    free(service);
}

/* Runs `work`; false where memory runs out: then all that can be read again is freed. */
static bool guard(Service *service, void (*work)(Service *, void *), void *user)
{
    jmp_buf exhausted;
    service->memory.exhausted = &exhausted;
    const bool enough         = setjmp(exhausted) == 0;
    if (enough)
        work(service, user);
    else {
        begin(service);
        service_forget(service);
    }
    service->memory.exhausted = NULL;
    return enough;
}

/* ---- documents ---- */

static char *copy(const char *bytes, size_t length)
{
    char *text = malloc(length + 1);
    if (text) {
        memcpy(text, bytes, length);
        text[length] = '\0';
    }
    return text;
}

/* Returns the path by which files know each other, for free(). */
static char *simplified(const char *path)
{
    char *own = copy(path, strlen(path));
    if (own)
        path_simplify(own);
    return own;
}

static Document *add_document(Service *service, const char *path)
{
    Document *document = calloc(1, sizeof *document);
    if (!document || !(document->path = copy(path, strlen(path)))) {
        free(document);
        return NULL;
    }
    document->next     = service->documents;
    service->documents = document;
    return document;
}

/* Takes over the text. */
static bool set_text(Service *service, Document *document, char *text, size_t length)
{
    if (!text || length > MAX_SOURCE_BYTES) {
        free(text);
        return false;
    }
    service_forget(service);
    free(document->text);
    document->text   = text;
    document->length = length;
    return true;
}

bool service_open(Service *service, const char *path, const char *uri, const char *text,
                  size_t length)
{
    char      *own      = simplified(path);
    Document  *document = own ? find_document(service, own) : NULL;
    const bool old      = document != NULL;
    if (own && !document)
        document = add_document(service, own);
    if (document && uri) {
        free(document->uri);
        document->uri = copy(uri, strlen(uri));
    }
    const bool good = document && set_text(service, document, copy(text, length), length);
    if (document && !good && !old)
        service_close(service, own);
    free(own);
    return good;
}

bool service_edit(Service *service, const char *path, Utf16Position from, Utf16Position to,
                  const char *text, size_t length)
{
    char     *own      = simplified(path);
    Document *document = own ? find_document(service, own) : NULL;
    free(own);
    if (!document)
        return false;
    const size_t start  = utf16_offset(document->text, document->length, from);
    size_t       end    = utf16_offset(document->text, document->length, to);
    end                 = end < start ? start : end;
    const size_t whole  = document->length - (end - start) + length;
    char        *edited = malloc(whole + 1);
    if (edited) {
        memcpy(edited, document->text, start);
        memcpy(edited + start, text, length);
        memcpy(edited + start + length, document->text + end, document->length - end);
        edited[whole] = '\0';
    }
    return set_text(service, document, edited, whole);
}

void service_close(Service *service, const char *path)
{
    char *own = simplified(path);
    for (Document **at = &service->documents; own && *at; at = &(*at)->next)
        if (strcmp((*at)->path, own) == 0) {
            Document *closed = *at;
            *at              = closed->next;
            closed->next     = NULL;
            documents_free(&closed);
            service_forget(service);
            break;
        }
    free(own);
}

/* ---- questions ---- */

static const struct {
    const char *name, *capability, *value;
    Answer     *answer;
} questions[] = {
#define QUESTION(name, function, capability, value) {name, capability, value, function},
#include "compiler/service/questions.def"
};
enum { QUESTION_COUNT = sizeof questions / sizeof *questions };

typedef struct Question {
    const ServiceQuestion *about;
    Document              *document;
    Answer                *answer;
} Question;

static void answer(Service *service, void *user)
{
    const Question *asked = user;
    Here            here  = {.service = service, .document = asked->document};
    here.analysis         = analyse(service, asked->document);
    here.file             = here.analysis->files.items[0];
    here.source           = &here.analysis->sources.items[here.file->source];
    here.offset = utf16_offset(here.source->text, here.source->length, asked->about->from);
    here.end    = utf16_offset(here.source->text, here.source->length, asked->about->to);
    asked->answer(&here, asked->about, &service->json);
}

static Answer *find_answer(const char *question)
{
    for (size_t i = 0; i < QUESTION_COUNT; i++)
        if (strcmp(questions[i].name, question) == 0)
            return questions[i].answer;
    return NULL;
}

bool service_knows(const char *question) { return find_answer(question) != NULL; }

const char *service_answer(Service *service, const char *question, const ServiceQuestion *about)
{
    Question asked = {.about = about, .answer = find_answer(question)};
    begin(service);
    if (!asked.answer)
        return NULL;
    char *path     = simplified(about->path);
    asked.document = path ? find_document(service, path) : NULL;
    free(path);
    if (!asked.document) {
        service->refusal = "the document is not open";
        return NULL;
    }
    if (!guard(service, answer, &asked))
        service->refusal = "there is not enough memory";
    return service->refusal ? NULL : service->json.text.bytes;
}

const char *service_refusal(const Service *service) { return service->refusal; }

void refuse_question(const Here *here, const char *reason) { here->service->refusal = reason; }

/* ---- capabilities ---- */

static void write_capabilities(Service *service, void *user)
{
    Json *json = &service->json;
    (void)user;
    json_open(json, NULL, "{");
    json_text(json, "positionEncoding", "utf-16");
    json_ready(json, "textDocumentSync", "{\"openClose\":true,\"change\":2,\"save\":true}");
    for (size_t i = 0; i < QUESTION_COUNT; i++)
        if (questions[i].capability)
            json_ready(json, questions[i].capability, questions[i].value);
    add_token_legend(json, "semanticTokensProvider");
    json_close(json, "}");
}

const char *service_capabilities(Service *service)
{
    begin(service);
    return guard(service, write_capabilities, NULL) ? service->json.text.bytes : NULL;
}

/* ---- diagnostics ---- */

/* Tells whether a file is the one of that name, or uses it.  There are no circles. */
static bool reaches(const Analysis *a, const File *file, const char *name)
{
    bool found = strcmp(a->sources.items[file->source].name, name) == 0;
    for (size_t i = 0; !found && i < file->used.count; i++)
        found = reaches(a, file->used.items[i], name);
    return found;
}

/* Returns the statement by which a document uses a file, directly or not; or NULL. */
static const Syntax *use_of(Analysis *a, const char *name)
{
    const File *file = a->files.items[0];
    for (uint32_t i = 0; i < file->syntax->count; i++) {
        const Syntax *use   = file->syntax->children[i];
        const File   *first = use->kind == SYNTAX_USE ? files_used(&a->files, file, use) : NULL;
        if (first && reaches(a, first, name))
            return use;
    }
    return NULL;
}

/* Adds JSON in which paths that follow `"uri":` become URIs.  No string has these characters: its quotes are escaped. */
static void add_with_uris(Service *service, const char *json, Text *out)
{
    static const char mark[] = "\"uri\":\"";
    for (const char *at; (at = strstr(json, mark)) != NULL;) {
        const char *path = at + sizeof mark - 1, *end = path;
        while (*end && *end != '"')
            end += *end == '\\' && end[1] ? 2 : 1;
        text_add_bytes(out, json, (size_t)(at - json));
        const char *given = arena_copy_text(&service->arena, path, (size_t)(end - path));
        text_add(out, "\"uri\":");
        text_json(out, uri_of(service, given));
        json = *end ? end + 1 : end;
    }
    text_add(out, json);
}

typedef struct Diagnosed {
    Document *document;
    Analysis *analysis;
    Service  *service;
} Diagnosed;

/* Adds a mistake in a file that the document uses, at the `use`. */
static void add_foreign(const Diagnosed *d, const char *source, const char *severity,
                        const char *code, const char *message)
{
    Service      *service = d->service;
    Json         *json    = &service->json;
    const Syntax *use     = use_of(d->analysis, source);
    Text          text    = {.arena = &service->arena};
    text_format(&text, "%s: %s", source, message);
    json_open(json, NULL, "{");
    const Source *own = &d->analysis->sources.items[d->analysis->files.items[0]->source];
    diag_json_range(json, "range", own, use ? use->span.start : 0, use ? use->span.end : 0);
    json_ready(json, "severity", severity);
    json_text(json, "code", code);
    json_text(json, "source", "krs");
    json_text(json, "message", text.bytes);
    json_close(json, "}");
}

static void add_diagnostic(const Diagnosed *d, const char *source, const char *severity,
                           const char *code, const char *message, const char *json)
{
    if (strcmp(source, d->document->path) != 0) {
        add_foreign(d, source, severity, code, message);
        return;
    }
    Text text = {.arena = &d->service->arena};
    add_with_uris(d->service, json, &text);
    json_ready(&d->service->json, NULL, text.bytes);
}

static void write_diagnostics(Service *service, void *user)
{
    static const char *const severities[] = {
        [DIAG_ERROR] = "1", [DIAG_WARNING] = "2", [DIAG_NOTE] = "3"};
    Diagnosed d = {.document = user, .service = service};
    d.analysis  = analyse(service, d.document);
    json_open(&service->json, NULL, "[");
    for (size_t i = 0; i < d.analysis->diags.count; i++) {
        const Diag     *diag = d.analysis->diags.items[i];
        const DiagInfo *info = &diag_info[diag->code];
        Text            text = {.arena = &service->arena};
        diag_json_one(&d.analysis->diags, diag, &text);
        add_diagnostic(&d, d.analysis->sources.items[diag->span.source].name,
                       severities[info->severity], info->code, diag->message, text.bytes);
    }
    json_close(&service->json, "]");
}

/* Tells of a diagnostic of the compiler. */
static void tell(void *user, const KrsDiagnostic *told)
{
    add_diagnostic(user, told->source,
                   told->error  ? "1"
                   : told->note ? "3"
                                : "2",
                   told->code, told->message, told->json);
}

/* Loads a text for the compiler, which has memory of its own. */
static const char *load(void *user, const char *path, size_t *length)
{
    return ((Diagnosed *)user)
        ->analysis->loader.supplier(((Diagnosed *)user)->service, path, length);
}

static void write_check(Service *service, void *user)
{
    Diagnosed d = {.document = user, .service = service};
    d.analysis  = analyse(service, d.document);
    json_open(&service->json, NULL, "[");
    const KrsOptions options = {
        .diagnostic = tell, .user = &d, .load = load, .load_user = &d, .figures = true};
    krs_check_text(d.document->text, d.document->length, d.document->path, &options);
    json_close(&service->json, "]");
}

static const char *diagnose(Service *service, const char *path,
                            void (*write)(Service *service, void *user))
{
    char     *own      = simplified(path);
    Document *document = own ? find_document(service, own) : NULL;
    free(own);
    begin(service);
    return document && guard(service, write, document) ? service->json.text.bytes : NULL;
}

const char *service_diagnostics(Service *service, const char *path)
{
    return diagnose(service, path, write_diagnostics);
}

const char *service_check(Service *service, const char *path)
{
    return diagnose(service, path, write_check);
}
