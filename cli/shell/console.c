/*
 * console.c: messages, numbers and the progress bar.
 */
#include "cli/shell/console.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "compiler/base/clock.h"
#include "compiler/base/text.h"
#include "compiler/base/visible.h"

void console_clear(void)
{
    if (isatty(STDERR_FILENO))
        fputs("\r\033[K", stderr);
}

void console_doing(const Options *options, const char *what)
{
    if (options->quiet || !isatty(STDERR_FILENO))
        return;
    console_clear();
    if (what)
        fprintf(stderr, "%s ...", what);
    fflush(stderr);
}

/* Prints words, in which names of files may have any bytes. */
static void say_words(const char *format, va_list words)
{
    char *line;
    fflush(stdout); /* keeps the order of the two streams on a terminal */
    console_clear();
    if (vasprintf(&line, format, words) < 0)
        line = NULL;
    fputs("krs: ", stderr);
    visible_print(stderr, line ? line : "out of memory");
    fputc('\n', stderr);
    free(line);
}

void say(const char *format, ...)
{
    va_list words;
    va_start(words, format);
    say_words(format, words);
    va_end(words);
}

KrsStatus say_usage(const Options *options, const char *format, ...)
{
    va_list words;
    va_start(words, format);
    say_words(format, words);
    va_end(words);
    if (options->command < COMMAND_COUNT)
        say("`krs %s --help` shows how it is used", command_table[options->command].name);
    else
        say("`krs --help` shows how it is used");
    return KRS_BAD_ARGUMENT;
}

KrsStatus say_no_command(const char *word)
{
    const char *nearest = nearest_command(word);
    if (nearest)
        say("there is no command `%s`; did you mean `%s`?", word, nearest);
    else
        say("there is no command `%s`", word);
    say("`krs help` lists the commands");
    return KRS_BAD_ARGUMENT;
}

bool console_color(const Options *options)
{
    const char *refused = getenv("NO_COLOR");
    if (options->color != WHEN_AUTO)
        return options->color == WHEN_ALWAYS;
    return isatty(STDERR_FILENO) && !(refused && *refused);
}

KrsStatus console_finish(void)
{
    if (fflush(stdout) == 0 && !ferror(stdout))
        return KRS_OK;
    say("error while writing standard output: %s", strerror(errno));
    return KRS_IO_ERROR;
}

const char *console_name(const Options *options, const char *path)
{
    Text name = {.arena = options->arena};
    text_add(&name, "");
    for (size_t left = strlen(path); left > 0;) {
        const Visible visible = visible_next(path, left);
        text_add_bytes(&name, visible.text, visible.length);
        path += visible.used;
        left -= visible.used;
    }
    return name.bytes;
}

void print_number(FILE *out, double number)
{
    char text[32];
    if (!isfinite(number)) {
        fputs(isnan(number) ? "nan" : number > 0 ? "inf" : "-inf", out);
        return;
    }
    for (int digits = 15; digits <= 17; digits++) {
        snprintf(text, sizeof text, "%.*g", digits, number);
        if (strtod(text, NULL) == number)
            break;
    }
    fputs(text, out);
}

double clock_now(void) { return clock_seconds(CLOCK_MONOTONIC); }

void progress_start(Progress *progress, const Options *options, size_t frames)
{
    *progress = (Progress){.off      = options->quiet,
                           .terminal = isatty(STDERR_FILENO) != 0,
                           .percent  = -1,
                           .frames   = frames};
}

static void draw_bar(const Progress *progress)
{
    enum { WIDTH = 40 };
    char bar[WIDTH + 1];
    int  filled = progress->percent * WIDTH / 100;
    memset(bar, ' ', WIDTH);
    memset(bar, '#', (size_t)filled);
    bar[WIDTH] = '\0';
    fprintf(stderr, "\r[%s] %3d%%\033[K", bar, progress->percent);
    if (progress->frames > 1)
        fprintf(stderr, " frame %zu of %zu", progress->frame + 1, progress->frames);
}

void progress_show(Progress *progress, double fraction)
{
    double now     = clock_now();
    double total   = ((double)progress->frame + fraction) / (double)progress->frames;
    int    percent = (int)(100 * fmin(fmax(total, 0), 1));
    double pause   = progress->terminal ? 0.1 : 1;
    if (progress->off || percent == progress->percent ||
        (progress->shown_at > 0 && now - progress->shown_at < pause))
        return;
    progress->shown_at = now;
    progress->percent  = percent;
    if (progress->terminal)
        draw_bar(progress);
    else
        fprintf(stderr, "Progress: %d%%\n", percent);
    fflush(stderr);
}

void progress_end(Progress *progress)
{
    if (progress->terminal && progress->shown_at > 0)
        fputs("\r\033[K", stderr);
    progress->shown_at = 0;
}
