/*
 * kubernetes.c: a description of a job for Kubernetes, in YAML.
 *
 * It is an Indexed Job: a pod for each piece, which finds its number in JOB_COMPLETION_INDEX.  A wrong scene is not
 * tried again; what has left a checkpoint is, and does not count as a failure.
 */
#include "cli/farm/kubernetes.h"

#include <ctype.h>
#include <string.h>
#include <xxhash.h>

#include "cli/shell/console.h"
#include "cli/shell/supervise.h"

enum {
    MAX_COMPLETIONS = 100000, /* of an Indexed Job that is not run one after the other */
    MAX_PODS        = 1000,   /* at once */
    NAME_LETTERS    = 40      /* names have at most 63, with what is around these */
};

/* Returns a name that Kubernetes takes: lower-case letters, digits and dashes. */
static const char *make_name(const FarmJob *job, Arena *arena)
{
    const char *slash  = strrchr(job->folder, '/');
    const char *folder = slash ? slash + 1 : job->folder;
    Text        name   = {.arena = arena};
    text_add(&name, "krs-");
    for (size_t i = 0; folder[i] && i < NAME_LETTERS; i++) {
        const char letter = (char)tolower((unsigned char)folder[i]);
        const bool plain  = (letter >= 'a' && letter <= 'z') || (letter >= '0' && letter <= '9');
        text_format(&name, "%c", plain ? letter : '-');
    }
    text_format(&name, "-%08x", (unsigned)XXH64(job->folder, strlen(job->folder), 0));
    return name.bytes;
}

/* Returns the folder of a path. */
static const char *folder_of(Arena *arena, const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash && slash > path ? arena_copy_text(arena, path, (size_t)(slash - path)) : "/";
}

static void add_entry(Text *text, const char *before, const char *value)
{
    text_add(text, before);
    text_json(text, value); /* a string of YAML, too */
    text_add(text, "\n");
}

/* Adds the folders of the job and of its pictures, as volumes or as places of the container. */
static void add_folders(Text *text, const FarmJob *job, bool volumes)
{
    const char *pictures = folder_of(text->arena, job->output);
    const struct {
        const char *name, *path;
    } folders[]        = {{"job", job->folder}, {"pictures", pictures}};
    const size_t count = strcmp(pictures, job->folder) == 0 ? 1 : 2;
    for (size_t i = 0; i < count && volumes; i++) {
        text_format(text, "        - name: %s\n          hostPath:\n            type: Directory\n",
                    folders[i].name);
        add_entry(text, "            path: ", folders[i].path);
    }
    for (size_t i = 0; i < count && !volumes; i++) {
        text_format(text, "            - name: %s\n", folders[i].name);
        add_entry(text, "              mountPath: ", folders[i].path);
    }
}

KrsStatus kubernetes_write(const FarmJob *job, const Options *options, const char *image)
{
    const uint32_t pieces = job_pieces(job);
    Text           text   = {.arena = options->arena};
    if (pieces > MAX_COMPLETIONS)
        return say_usage(options,
                         "a Job of Kubernetes has at most %d pieces, not %u; --chunk makes fewer",
                         MAX_COMPLETIONS, pieces);
    if (strchr(job->folder, ':') || strchr(job->output, ':'))
        return say_usage(options, "places in containers of Kubernetes have no `:` in their paths");
    text_add(&text, "apiVersion: batch/v1\nkind: Job\nmetadata:\n");
    add_entry(&text, "  name: ", make_name(job, options->arena));
    text_format(&text,
                "spec:\n"
                "  completionMode: Indexed\n"
                "  completions: %u\n"
                "  parallelism: %u\n"
                "  backoffLimitPerIndex: 3\n"
                "  podFailurePolicy:\n"
                "    rules:\n"
                "      - action: FailIndex # a wrong scene, or wrong usage\n"
                "        onExitCodes:\n"
                "          containerName: krs\n"
                "          operator: In\n"
                "          values: [1, 2]\n"
                "      - action: Ignore # there is a checkpoint\n"
                "        onExitCodes:\n"
                "          containerName: krs\n"
                "          operator: In\n"
                "          values: [75]\n"
                "  template:\n"
                "    spec:\n"
                "      restartPolicy: Never\n"
                "      terminationGracePeriodSeconds: 60\n"
                "      containers:\n"
                "        - name: krs\n",
                pieces, pieces < MAX_PODS ? pieces : MAX_PODS);
    add_entry(&text, "          image: ", image);
    add_entry(&text, "          command: [krs, farm, run, ", job->folder);
    text.length--;
    text_add(&text, "]\n          volumeMounts:\n");
    add_folders(&text, job, false);
    text_add(&text, "      volumes:\n");
    add_folders(&text, job, true);
    return write_output_text(job_path(job, options->arena, "kubernetes.yaml"), text.bytes,
                             text.length);
}
