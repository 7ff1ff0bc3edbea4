/*
 * probe.c: whether a machine makes the pictures that the others make.
 */
#include "cli/farm/probe.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
#define XXH_STATIC_LINKING_ONLY /* for the size of a state */
#include <xxhash.h>

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

/* Adds a text of one line that a file has, if there is one. */
static void hash_line(XXH64_state_t *hash, const char *path)
{
    char  line[256] = "";
    FILE *file      = fopen(path, "r");
    if (file && fgets(line, sizeof line, file))
        XXH64_update(hash, line, strlen(line));
    if (file)
        fclose(file);
}

/* Returns the name of this machine, as it is since it was started, with its devices: containers may share the name
   of a host, and drivers change. */
static const char *name_machine(Arena *arena)
{
    char          host[256] = "";
    size_t        count     = 0;
    Text          name      = {.arena = arena};
    XXH64_state_t hash;
    XXH64_reset(&hash, 0);
    gethostname(host, sizeof host - 1);
    hash_line(&hash, "/proc/sys/kernel/random/boot_id");
    krs_devices(NULL, 0, &count);
    KrsDevice   *devices  = arena_new_array(arena, KrsDevice, count + 1);
    const size_t capacity = count;
    if (krs_devices(devices, capacity, &count) == KRS_OK)
        for (size_t i = 0; i < count && i < capacity; i++) {
            XXH64_update(&hash, devices[i].name, strlen(devices[i].name));
            XXH64_update(&hash, &devices[i].api_version, sizeof devices[i].api_version);
        }
    text_format(&name, "%s-%016llx", host, (unsigned long long)XXH64_digest(&hash));
    return name.bytes;
}

KrsStatus probe(const FarmJob *job, const Options *options)
{
    const char *host = name_machine(options->arena);
    Text        own = {.arena = options->arena}, made = {.arena = options->arena};
    const char *first = job_path(job, options->arena, "probes/first.exr");
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
