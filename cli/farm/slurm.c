/*
 * slurm.c: hands a job to Slurm, as arrays of tasks, and a task behind them that writes what they have left.
 *
 * A task is a piece.  Slurm's arrays have a largest index, so a job of more pieces is several arrays, each of which
 * begins at KRS_FARM_FIRST.
 */
#include "cli/farm/slurm.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/shell/console.h"
#include "cli/shell/supervise.h"

enum { MAX_TASKS = 1000 }; /* of an array: MaxArraySize is 1001 if nobody has changed it */
#define WARNING "60"       /* seconds before the limit of time, when tasks leave a checkpoint */

/* What follows the command in a script.  Slurm tells the script, not the command, that time is over.  What has left a
   checkpoint is queued again. */
static const char wait_and_requeue[] =
    " &\n"
    "child=$!\n"
    "trap 'kill -USR1 $child' USR1\n"
    "trap 'kill -TERM $child' TERM\n"
    "wait $child\n"
    "status=$?\n"
    "while kill -0 $child 2>/dev/null; do\n"
    "    wait $child\n"
    "    status=$?\n"
    "done\n"
    "[ $status -ne 75 ] || exec scontrol requeue \"$SLURM_JOB_ID\"\n"
    "exit $status\n";

/* Adds a word as the shell reads it. */
static void add_quoted(Text *text, const char *word)
{
    text_add(text, "'");
    for (; *word; word++)
        if (*word == '\'')
            text_add(text, "'\\''");
        else
            text_add_bytes(text, word, 1);
    text_add(text, "'");
}

static KrsStatus write_script(const FarmJob *job, const Options *options, const char *name,
                              const char *verb)
{
    char    program[4096];
    Text    script = {.arena = options->arena};
    ssize_t length = readlink("/proc/self/exe", program, sizeof program - 1);
    if (length < 0) {
        say("cannot find krs itself: %s", strerror(errno));
        return KRS_IO_ERROR;
    }
    program[length] = '\0';
    text_add(&script, "#!/bin/sh\n");
    add_quoted(&script, program);
    text_format(&script, " farm %s ", verb);
    add_quoted(&script, job->folder);
    text_add(&script, wait_and_requeue);
    return write_output_text(job_path(job, options->arena, name), script.bytes, script.length);
}

/* Runs a command, and returns the number that it prints; 0: it failed. */
static unsigned long run_sbatch(const Text *command)
{
    char  line[256] = "";
    FILE *pipe      = popen(command->bytes, "r");
    if (!pipe)
        return 0;
    if (!fgets(line, sizeof line, pipe))
        line[0] = '\0';
    return pclose(pipe) == 0 ? strtoul(line, NULL, 10) : 0;
}

static Text begin_command(const FarmJob *job, const Options *options, const char *partition)
{
    Text command = {.arena = options->arena};
    text_add(
        &command,
        "sbatch --parsable --job-name=krs --requeue --open-mode=append --signal=B:USR1@" WARNING
        " --partition=");
    add_quoted(&command, partition);
    text_add(&command, " --output=");
    add_quoted(&command, job_path(job, options->arena, "slurm.log"));
    return command;
}

KrsStatus slurm_submit(const FarmJob *job, const Options *options, const char *partition)
{
    Text      numbers = {.arena = options->arena}, after = {.arena = options->arena};
    KrsStatus status = write_script(job, options, "piece.sh", "run");
    if (status == KRS_OK)
        status = write_script(job, options, "rest.sh", "work");
    for (uint32_t first = 0; first < job_pieces(job) && status == KRS_OK; first += MAX_TASKS) {
        const uint32_t left    = job_pieces(job) - first;
        Text           command = begin_command(job, options, partition);
        text_format(&command, " --array=0-%u --export=ALL,KRS_FARM_FIRST=%u ",
                    (left < MAX_TASKS ? left : MAX_TASKS) - 1, first);
        add_quoted(&command, job_path(job, options->arena, "piece.sh"));
        const unsigned long number = run_sbatch(&command);
        status                     = number ? KRS_OK : KRS_IO_ERROR;
        if (number) {
            text_format(&numbers, "%lu\n", number);
            text_format(&after, ":%lu", number);
        }
    }
    if (status == KRS_OK) {
        Text command = begin_command(job, options, partition);
        text_format(&command, " --dependency=afterany%s ", after.bytes);
        add_quoted(&command, job_path(job, options->arena, "rest.sh"));
        const unsigned long number = run_sbatch(&command);
        status                     = number ? KRS_OK : KRS_IO_ERROR;
        if (number)
            text_format(&numbers, "%lu\n", number);
    }
    if (status != KRS_OK)
        say("sbatch has not taken the job; `krs farm work %s` renders it here", job->folder);
    /* What was queued before sbatch failed can still be cancelled. */
    const KrsStatus written = numbers.length
                                  ? write_output_text(job_path(job, options->arena, "slurm.jobs"),
                                                      numbers.bytes, numbers.length)
                                  : KRS_OK;
    return status == KRS_OK ? written : status;
}

KrsStatus slurm_cancel(const FarmJob *job, const Options *options)
{
    FILE         *numbers = fopen(job_path(job, options->arena, "slurm.jobs"), "r");
    Text          command = {.arena = options->arena};
    unsigned long number;
    if (!numbers)
        return KRS_OK;
    text_add(&command, "scancel");
    while (fscanf(numbers, "%lu", &number) == 1)
        text_format(&command, " %lu", number);
    fclose(numbers);
    if (system(command.bytes) == 0)
        return KRS_OK;
    say("scancel has failed");
    return KRS_IO_ERROR;
}
