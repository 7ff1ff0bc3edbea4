/*
 * editor.c: what the editor of a page asks.
 */
#include <stdlib.h>
#include <string.h>

#include "compiler/base/embedded.h"
#include "compiler/service/service.h"
#include "web/core/core.h"
#include "web/core/page.h"

static Service *service;

/* Changes that diagnostics propose, for the next question; their texts are copies. */
enum { MAX_FIXES = 32 };
static ServiceFix fixes[MAX_FIXES];
static size_t     fix_count;

static Service *get_service(void)
{
    static const ServiceHost host = {.read = supply_text};
    if (!service)
        service = service_new(&host);
    return service;
}

static Utf16Position start_of(const uint32_t place[4])
{
    return (Utf16Position){place[0], place[1]};
}
static Utf16Position end_of(const uint32_t place[4]) { return (Utf16Position){place[2], place[3]}; }

bool core_open(const char *name, const char *text, size_t length)
{
    return get_service() && service_open(service, name, NULL, text, length);
}

bool core_edit(const char *name, const uint32_t place[4], const char *text, size_t length)
{
    return get_service() &&
           service_edit(service, name, start_of(place), end_of(place), text, length);
}

void core_close(const char *name)
{
    if (service)
        service_close(service, name);
}

void core_fix(const uint32_t place[4], const char *replacement, const char *diagnostic)
{
    ServiceFix fix = {start_of(place), end_of(place), strdup(replacement), strdup(diagnostic)};
    if (fix_count < MAX_FIXES && fix.replacement && fix.diagnostic) {
        fixes[fix_count++] = fix;
        return;
    }
    free((char *)fix.replacement);
    free((char *)fix.diagnostic);
}

const char *core_ask(const char *question, const char *name, const uint32_t place[4],
                     const char *word, bool definition, const double *color)
{
    ServiceQuestion about = {.path       = name,
                             .from       = start_of(place),
                             .to         = end_of(place),
                             .word       = word,
                             .definition = definition,
                             .fixes      = fixes,
                             .fix_count  = fix_count};
    memcpy(about.color, color, sizeof about.color);
    const char *answer = get_service() ? service_answer(service, question, &about) : NULL;
    for (; fix_count > 0; fix_count--) {
        free((char *)fixes[fix_count - 1].replacement);
        free((char *)fixes[fix_count - 1].diagnostic);
    }
    return answer;
}

const char *core_refusal(void) { return service ? service_refusal(service) : NULL; }

const char *core_mistakes(const char *name)
{
    return get_service() ? service_diagnostics(service, name) : NULL;
}

const char *core_capabilities(void) { return get_service() ? service_capabilities(service) : NULL; }

const char *core_library(const char *name)
{
    const EmbeddedFile *file = embedded_find(library_files, name);
    return file ? file->text : NULL;
}
