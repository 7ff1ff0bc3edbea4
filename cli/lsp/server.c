/*
 * server.c: `krs lsp`: the messages of an editor, one after the other.
 *
 * A question is answered at once, by what is open now.  Mistakes are told when no message waits: those of reading first, and
 * those of a whole check when the editor is quiet.
 */
#include "cli/lsp/server.h"

#include <errno.h>
#include <jansson.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"

/* Errors of JSON-RPC and of the protocol. */
enum {
    PARSE_ERROR      = -32700,
    INVALID_REQUEST  = -32600,
    METHOD_NOT_FOUND = -32601,
    INVALID_PARAMS   = -32602,
    NOT_INITIALIZED  = -32002,
    REQUEST_FAILED   = -32803
};

/* The time without an edit before a whole check begins, in milliseconds. */
enum { QUIET = 150 };

/* An open document: how the editor calls it, and what it has not been told. */
typedef struct Opened {
    char          *uri, *path;
    json_int_t     version;
    bool           unread, unchecked; /* mistakes of reading, and of a check, are to be told */
    char          *told;              /* the diagnostics that it was told last, of this version: */
    json_int_t     told_version;
    struct Opened *next;
} Opened;

typedef struct Server {
    Service *service;
    Opened  *opened;
    Frames   frames;
    Check    check;
    Opened  *checked; /* the document that is checked; NULL: it has been closed */
    bool     initialized, shut_down, ended;
    bool     lost; /* nobody reads */
} Server;

/* ---- messages out ---- */

static void send_text(Server *server, char *text, int length)
{
    if (length < 0 || !frame_write(STDOUT_FILENO, text, (size_t)length))
        server->lost = true;
    if (length >= 0)
        free(text);
}

static void send(Server *server, const char *format, ...) __attribute__((format(printf, 2, 3)));
static void send(Server *server, const char *format, ...)
{
    char   *text;
    va_list arguments;
    va_start(arguments, format);
    const int length = vasprintf(&text, format, arguments);
    va_end(arguments);
    send_text(server, text, length);
}

/* Returns the identifier of a request as JSON, for free(). */
static char *id_text(const json_t *id)
{
    char *text = id ? json_dumps(id, JSON_ENCODE_ANY | JSON_COMPACT) : NULL;
    return text ? text : strdup("null");
}

static void send_result(Server *server, const json_t *id, const char *result)
{
    char *text = id_text(id);
    send(server, "{\"jsonrpc\":\"2.0\",\"id\":%s,\"result\":%s}", text ? text : "null", result);
    free(text);
}

static void send_error(Server *server, const json_t *id, int code, const char *message)
{
    char   *text = id_text(id);
    json_t *word = json_string_nocheck(message);
    char   *json = word ? json_dumps(word, JSON_ENCODE_ANY) : NULL;
    send(server, "{\"jsonrpc\":\"2.0\",\"id\":%s,\"error\":{\"code\":%d,\"message\":%s}}",
         text ? text : "null", code, json ? json : "\"\"");
    free(json);
    json_decref(word);
    free(text);
}

/* Sends diagnostics, unless the editor was told the same of this version. */
static void send_diagnostics(Server *server, Opened *opened, const char *found)
{
    if (opened->told && opened->told_version == opened->version && strcmp(opened->told, found) == 0)
        return;
    json_t *word = json_string_nocheck(opened->uri);
    char   *uri  = word ? json_dumps(word, JSON_ENCODE_ANY) : NULL;
    send(server,
         "{\"jsonrpc\":\"2.0\",\"method\":\"textDocument/publishDiagnostics\",\"params\":"
         "{\"uri\":%s,\"version\":%" JSON_INTEGER_FORMAT ",\"diagnostics\":%s}}",
         uri ? uri : "\"\"", opened->version, found);
    free(uri);
    json_decref(word);
    free(opened->told);
    opened->told         = strdup(found);
    opened->told_version = opened->version;
}

/* ---- parameters ---- */

static uint32_t number_of(const json_t *object, const char *name)
{
    const json_int_t number = json_integer_value(json_object_get(object, name));
    return number < 0 ? 0 : number > UINT32_MAX ? UINT32_MAX : (uint32_t)number;
}

static Utf16Position position_of(const json_t *position)
{
    return (Utf16Position){number_of(position, "line"), number_of(position, "character")};
}

static Opened *find_opened(const Server *server, const json_t *parameters)
{
    const char *uri = json_string_value(
        json_object_get(json_object_get(parameters, "textDocument"), "uri"));
    Opened *opened = server->opened;
    while (opened && (!uri || strcmp(opened->uri, uri) != 0))
        opened = opened->next;
    return uri ? opened : NULL;
}

/* ---- documents ---- */

/* Marks all documents for a check: each may use the one that changed. */
static void doubt_all(Server *server)
{
    check_stop(&server->check);
    for (Opened *opened = server->opened; opened; opened = opened->next)
        opened->unread = opened->unchecked = true;
}

static Opened *add_opened(Server *server, const char *uri)
{
    Opened *opened = calloc(1, sizeof *opened);
    if (!opened)
        return NULL;
    opened->uri  = strdup(uri);
    opened->path = path_of_uri(uri);
    if (!opened->uri || !opened->path) {
        free(opened->uri);
        free(opened->path);
        free(opened);
        return NULL;
    }
    opened->next   = server->opened;
    server->opened = opened;
    return opened;
}

static void remove_opened(Server *server, Opened *opened)
{
    Opened **at = &server->opened;
    while (*at != opened)
        at = &(*at)->next;
    *at = opened->next;
    if (server->checked == opened)
        server->checked = NULL;
    free(opened->uri);
    free(opened->path);
    free(opened->told);
    free(opened);
}

static void did_open(Server *server, const json_t *parameters)
{
    const json_t *document = json_object_get(parameters, "textDocument");
    const json_t *text     = json_object_get(document, "text");
    const char   *uri      = json_string_value(json_object_get(document, "uri"));
    Opened       *opened   = find_opened(server, parameters);
    if (!uri || !json_is_string(text))
        return;
    if (!opened)
        opened = add_opened(server, uri);
    if (!opened || !service_open(server->service, opened->path, uri, json_string_value(text),
                                 json_string_length(text))) {
        say("`%s` is not opened: it is too long, or there is no memory", uri);
        if (opened)
            remove_opened(server, opened);
        return;
    }
    opened->version = json_integer_value(json_object_get(document, "version"));
    doubt_all(server);
}

static void change(Server *server, const Opened *opened, const json_t *part)
{
    const json_t *text = json_object_get(part, "text"), *range = json_object_get(part, "range");
    if (!json_is_string(text))
        return;
    const bool done = range ? service_edit(server->service, opened->path,
                                           position_of(json_object_get(range, "start")),
                                           position_of(json_object_get(range, "end")),
                                           json_string_value(text), json_string_length(text))
                            : service_open(server->service, opened->path, opened->uri,
                                           json_string_value(text), json_string_length(text));
    if (!done)
        say("a change of `%s` is lost: it is too long, or there is no memory", opened->uri);
}

static void did_change(Server *server, const json_t *parameters)
{
    Opened *opened = find_opened(server, parameters);
    size_t  i;
    json_t *part;
    if (!opened)
        return;
    json_array_foreach(json_object_get(parameters, "contentChanges"), i, part)
        change(server, opened, part);
    opened->version = json_integer_value(
        json_object_get(json_object_get(parameters, "textDocument"), "version"));
    doubt_all(server);
}

static void did_close(Server *server, const json_t *parameters)
{
    Opened *opened = find_opened(server, parameters);
    if (!opened)
        return;
    service_close(server->service, opened->path);
    send_diagnostics(server, opened, "[]");
    remove_opened(server, opened);
    doubt_all(server);
}

static void files_changed(Server *server, const json_t *parameters)
{
    (void)parameters;
    service_forget(server->service);
    doubt_all(server);
}

/* ---- the life of the server ---- */

static void initialize(Server *server, const json_t *id)
{
    char       *result;
    const char *capabilities = service_capabilities(server->service);
    if (!capabilities ||
        asprintf(&result,
                 "{\"capabilities\":%s,\"serverInfo\":{\"name\":\"krs\",\"version\":\"%s\"}}",
                 capabilities, krs_version()) < 0) {
        send_error(server, id, REQUEST_FAILED, "there is not enough memory");
        return;
    }
    server->initialized = true;
    send_result(server, id, result);
    free(result);
}

static void note(Server *server, const char *method, const json_t *parameters)
{
    static const struct {
        const char *method;
        void (*handle)(Server *server, const json_t *parameters);
    } notifications[] = {
        {"textDocument/didOpen", did_open},
        {"textDocument/didChange", did_change},
        {"textDocument/didClose", did_close},
        {"textDocument/didSave", files_changed},
        {"workspace/didChangeWatchedFiles", files_changed},
    };
    if (strcmp(method, "exit") == 0)
        server->ended = true;
    for (size_t i = 0; server->initialized && i < sizeof notifications / sizeof *notifications; i++)
        if (strcmp(method, notifications[i].method) == 0)
            notifications[i].handle(server, parameters);
}

/* ---- questions ---- */

enum { MAX_FIXES = 64 };

/* Finds the fixes that the diagnostics at a place propose.  Texts of `dumped` are for free(). */
static size_t find_fixes(const json_t *parameters, ServiceFix *fixes, char **dumped)
{
    const json_t *found = json_object_get(json_object_get(parameters, "context"), "diagnostics");
    size_t        count = 0, i;
    json_t       *diagnostic;
    json_array_foreach(found, i, diagnostic)
    {
        const char *replacement = json_string_value(
            json_object_get(json_object_get(diagnostic, "data"), "replacement"));
        const json_t *range = json_object_get(diagnostic, "range");
        if (!replacement || count == MAX_FIXES)
            continue;
        dumped[count] = json_dumps(diagnostic, JSON_COMPACT);
        if (!dumped[count])
            continue;
        fixes[count] = (ServiceFix){position_of(json_object_get(range, "start")),
                                    position_of(json_object_get(range, "end")), replacement,
                                    dumped[count]};
        count++;
    }
    return count;
}

/* Returns the question; `position` is its own, unless it is about a range. */
static ServiceQuestion question_of(const Opened *opened, const json_t *parameters,
                                   const json_t *position)
{
    const json_t   *range = json_object_get(parameters, "range");
    const json_t   *color = json_object_get(parameters, "color");
    ServiceQuestion about = {.path = opened->path};
    about.from            = position_of(range ? json_object_get(range, "start") : position);
    about.to              = position_of(range ? json_object_get(range, "end") : position);
    about.word            = json_string_value(json_object_get(parameters, "newName"));
    about.definition      = json_is_true(
             json_object_get(json_object_get(parameters, "context"), "includeDeclaration"));
    about.color[0] = json_number_value(json_object_get(color, "red"));
    about.color[1] = json_number_value(json_object_get(color, "green"));
    about.color[2] = json_number_value(json_object_get(color, "blue"));
    return about;
}

/* Asks a question about several positions: each answer is an array, and so is what is sent. */
static void ask_each(Server *server, const json_t *id, const char *method, const json_t *parameters,
                     const json_t *positions)
{
    const Opened *opened = find_opened(server, parameters);
    json_t       *all    = json_array(), *position;
    size_t        i;
    json_array_foreach(positions, i, position)
    {
        const ServiceQuestion about  = question_of(opened, parameters, position);
        const char           *answer = service_answer(server->service, method, &about);
        json_t               *one    = answer ? json_loads(answer, 0, NULL) : NULL;
        json_array_extend(all, one);
        json_decref(one);
    }
    char *text = json_dumps(all, JSON_COMPACT);
    send_result(server, id, text ? text : "null");
    free(text);
    json_decref(all);
}

static void ask(Server *server, const json_t *id, const char *method, const json_t *parameters)
{
    const Opened *opened = find_opened(server, parameters);
    ServiceFix    fixes[MAX_FIXES];
    char         *dumped[MAX_FIXES];
    if (!opened) {
        /* A question about nothing tells whether there is one of this name. */
        const bool known = service_knows(method);
        send_error(server, id, known ? INVALID_PARAMS : METHOD_NOT_FOUND,
                   known ? "the document is not open" : "there is no such method");
        return;
    }
    const json_t *positions = json_object_get(parameters, "positions");
    if (positions) {
        ask_each(server, id, method, parameters, positions);
        return;
    }
    ServiceQuestion about = question_of(opened, parameters,
                                        json_object_get(parameters, "position"));
    about.fixes           = fixes;
    about.fix_count       = find_fixes(parameters, fixes, dumped);
    const char *answer    = service_answer(server->service, method, &about);
    const char *refusal   = service_refusal(server->service);
    if (answer)
        send_result(server, id, answer);
    else
        send_error(server, id, refusal ? REQUEST_FAILED : METHOD_NOT_FOUND,
                   refusal ? refusal : "there is no such method");
    for (size_t i = 0; i < about.fix_count; i++)
        free(dumped[i]);
}

static void request(Server *server, const json_t *id, const char *method, const json_t *parameters)
{
    if (strcmp(method, "initialize") == 0 && !server->initialized)
        initialize(server, id);
    else if (!server->initialized)
        send_error(server, id, NOT_INITIALIZED, "the server is not initialized");
    else if (server->shut_down || strcmp(method, "initialize") == 0)
        send_error(server, id, INVALID_REQUEST, "not at this time");
    else if (strcmp(method, "shutdown") == 0) {
        server->shut_down = true;
        send_result(server, id, "null");
    } else
        ask(server, id, method, parameters);
}

static void read_message(Server *server, const char *text, size_t length)
{
    json_error_t  error;
    json_t       *message = json_loadb(text, length, JSON_ALLOW_NUL, &error);
    const json_t *id      = json_object_get(message, "id");
    const char   *method  = json_string_value(json_object_get(message, "method"));
    if (!message)
        send_error(server, NULL, PARSE_ERROR, error.text);
    else if (method && id)
        request(server, id, method, json_object_get(message, "params"));
    else if (method)
        note(server, method, json_object_get(message, "params"));
    else if (!json_object_get(message, "result") && !json_object_get(message, "error"))
        send_error(server, id, INVALID_REQUEST, "neither a request nor a notification");
    json_decref(message);
}

/* ---- diagnostics ---- */

/* Tells mistakes of reading.  Where there are none, what a check told before stays until it is done again. */
static bool tell_unread(Server *server)
{
    Opened *opened = server->opened;
    while (opened && !opened->unread)
        opened = opened->next;
    if (!opened)
        return false;
    opened->unread    = false;
    const char *found = service_diagnostics(server->service, opened->path);
    if (found && strcmp(found, "[]") != 0)
        send_diagnostics(server, opened, found);
    return true;
}

static bool begin_check(Server *server)
{
    Opened *opened = server->opened;
    while (opened && !opened->unchecked)
        opened = opened->next;
    if (!opened)
        return false;
    opened->unchecked = false;
    server->checked   = opened;
    return check_start(&server->check, server->service, opened->path);
}

/* Publishes the result of a check.  If it ended without one, the diagnostics of reading are all
   that is known. */
static void end_check(Server *server)
{
    Opened *opened = server->checked;
    if (!opened)
        return;
    const char *found = server->check.found;
    if (!found)
        found = service_diagnostics(server->service, opened->path);
    send_diagnostics(server, opened, found ? found : "[]");
}

static bool has_unchecked(const Server *server)
{
    const Opened *opened = server->opened;
    while (opened && !opened->unchecked)
        opened = opened->next;
    return opened != NULL;
}

/* ---- the loop ---- */

/* Waits for a message or the end of a check, and does what there is time for when none comes.  False: nothing more
   comes. */
static bool wait_for_editor(Server *server)
{
    const bool    runs    = server->check.process != 0;
    struct pollfd ends[2] = {{STDIN_FILENO, POLLIN, 0},
                             {runs ? server->check.pipe : -1, POLLIN, 0}};
    bool          told    = false;
    int           ready   = poll(ends, 2, 0);
    if (ready == 0)
        told = tell_unread(server);
    if (ready == 0 && !told)
        ready = poll(ends, 2, !runs && has_unchecked(server) ? QUIET : -1);
    if (ready == 0 && !told)
        begin_check(server);
    if (ready < 0)
        return errno == EINTR;
    if (ends[1].revents && check_read(&server->check))
        end_check(server);
    return !ends[0].revents || frames_read(&server->frames, STDIN_FILENO);
}

static void serve(Server *server)
{
    const char *message;
    size_t      length;
    do
        while (!server->ended && !server->lost && frames_next(&server->frames, &message, &length))
            read_message(server, message, length);
    while (!server->ended && !server->lost && !server->frames.broken && !*interrupted() &&
           wait_for_editor(server));
}

KrsStatus command_lsp(Options *options)
{
    Places      places = {.folder = cache_folder(options)};
    ServiceHost host   = {.uri = place_uri, .list = place_list, .user = &places};
    Server      server = {.service = service_new(&host)};
    if (!server.service)
        return KRS_OUT_OF_MEMORY;
    stage_enter(STAGE_WAIT);
    serve(&server);
    if (server.frames.broken)
        say("what comes from the editor is no message of the language server protocol");
    check_stop(&server.check);
    while (server.opened)
        remove_opened(&server, server.opened);
    service_free(server.service);
    places_free(&places);
    free(server.frames.bytes);
    free(server.check.found);
    if (*interrupted())
        return KRS_INTERRUPTED;
    return server.ended && server.shut_down ? KRS_OK : KRS_BAD_SCENE;
}
