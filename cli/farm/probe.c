/*
 * probe.c: whether a machine makes the pictures that the others make.
 */
#include "cli/farm/probe.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/farm/spawn.h"
#include "cli/shell/console.h"
#include "compiler/base/disk.h"

/* Tells whether an option would make the small picture large, or is the probe's own. */
static bool is_replaced(const char *word)
{
    static const char *const replaced[] = {"--size=", "--samples=", "--noise=", "--quiet"};
    for (size_t i = 0; i < sizeof replaced / sizeof *replaced; i++)
        if (strncmp(word, replaced[i], strlen(replaced[i])) == 0)
            return true;
    return false;
}

static KrsStatus render(const FarmJob *job, const Options *options, const char *picture)
{
    Words words = {0};
    Text  frame = {.arena = options->arena}, output = {.arena = options->arena};
    spawn_begin(options->arena, &words, "render", job_path(job, options->arena, "scene.krsz"));
    for (size_t i = 0; i < job->word_count; i++)
        if (!is_replaced(job->words[i]))
            spawn_add(options->arena, &words, job->words[i]);
    text_format(&output, "--output=%s", picture);
    spawn_add(options->arena, &words, output.bytes);
    spawn_add(options->arena, &words, "--size=48x27");
    /* Ranges say which device made them. */
    spawn_add(options->arena, &words, job->ranges > 1 ? "--samples=0..1/2" : "--samples=2");
    spawn_add(options->arena, &words, "--quiet");
    if (job->animated) {
        text_format(&frame, "--frames=%u..%u", job->first, job->first);
        spawn_add(options->arena, &words, frame.bytes);
    }
    return (KrsStatus)spawn_run(options, &words, NULL);
}

static bool same_bytes(const char *a, const char *b)
{
    const Loaded x = disk_read(a), y = disk_read(b);
    const bool   same = x.text && y.text && x.length == y.length &&
                      memcmp(x.text, y.text, x.length) == 0;
    free(x.owned);
    free(y.owned);
    return same;
}

KrsStatus probe(const FarmJob *job, const Options *options)
{
    char        host[256] = "";
    Text        own = {.arena = options->arena}, made = {.arena = options->arena};
    const char *first = job_path(job, options->arena, "probes/first.exr");
    gethostname(host, sizeof host - 1);
    text_format(&own, "%s/probes/%s.exr", job->folder, host);
    text_format(&made, "%s/probes/%s-%d%s.exr", job->folder, host, (int)getpid(),
                job->animated ? "-%d" : "");
    if (access(own.bytes, F_OK) == 0)
        return KRS_OK;
    KrsStatus status = render(job, options, made.bytes);
    if (status != KRS_OK)
        return status;
    Text written = {.arena = options->arena};
    text_format(&written, "%s/probes/%s-%d", job->folder, host, (int)getpid());
    if (job->animated)
        text_format(&written, "-%u", job->first);
    text_add(&written, ".exr");
    const bool is_first = link(written.bytes, first) == 0;
    if (!is_first && errno != EEXIST) {
        say("cannot create `%s`: %s", first, strerror(errno));
        return KRS_CANNOT_CREATE;
    }
    if (is_first || same_bytes(written.bytes, first)) {
        rename(written.bytes, own.bytes);
        return KRS_OK;
    }
    say("this machine's pictures differ from those of the machine that was first, as with another "
        "driver: `%s` and "
        "`%s`",
        written.bytes, first);
    return KRS_NO_DEVICE;
}
