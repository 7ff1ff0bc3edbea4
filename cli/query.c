/*
 * query.c: `krs query`: points and rays in, distances and hits out.
 *
 * Input is answered as it comes: whatever one read() brings is answered before the next, so
 * that a program may hold a conversation over two pipes, and a file still goes through in
 * large batches.
 */
#include <endian.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/shell/commands.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"

enum {
    BATCH      = 16384,
    INPUT_SIZE = 1 << 20, /* also the longest line */
    RECORD_IN  = 6 * 8,   /* bytes of a binary question */
    RECORD_OUT = 10       /* numbers of a binary answer */
};

typedef struct Query {
    const Options *options;
    KrsState      *state;
    KrsRenderer   *renderer;
    KrsRendering  *rendering; /* NULL: the host answers */
    KrsStatus      status;    /* of the answers so far */
    size_t         count;     /* questions that wait in the batch */
    bool           is_ray[BATCH];
    double         origins[BATCH][3], directions[BATCH][3];
    double         gathered[BATCH][3], aims[BATCH][3]; /* of one kind, without gaps */
    KrsHit         hits[BATCH], answers[BATCH];
    uint64_t       line; /* the last one that was read */
} Query;

static KrsStatus answer_gathered(Query *query, bool rays, size_t count)
{
    const double(*points)[3] = (const double(*)[3])query->gathered;
    const double(*aims)[3]   = (const double(*)[3])query->aims;
    double farthest = query->options->farthest, tolerance = query->options->tolerance;
    if (!query->rendering && rays)
        return krs_raycast(query->state, points, aims, count, farthest, tolerance, query->hits);
    if (!query->rendering)
        return krs_probe(query->state, points, count, query->hits);
    KrsStatus status = rays ? krs_device_raycast(query->rendering, query->state, points, aims,
                                                 count, farthest, tolerance, query->hits)
                            : krs_device_probe(query->rendering, query->state, points, count,
                                               query->hits);
    if (status != KRS_OK)
        say("%s", krs_renderer_message(query->renderer));
    return status;
}

/* Answers the questions of one kind, points or rays. */
static KrsStatus answer_kind(Query *query, bool rays)
{
    size_t count = 0;
    for (size_t i = 0; i < query->count; i++)
        if (query->is_ray[i] == rays) {
            memcpy(query->gathered[count], query->origins[i], sizeof query->gathered[0]);
            memcpy(query->aims[count++], query->directions[i], sizeof query->aims[0]);
        }
    KrsStatus status = count > 0 ? answer_gathered(query, rays, count) : KRS_OK;
    for (size_t i = 0, next = 0; i < query->count && status == KRS_OK; i++)
        if (query->is_ray[i] == rays)
            query->answers[i] = query->hits[next++];
    return status;
}

static void print_text(bool is_ray, const KrsHit *hit)
{
    if (is_ray && !hit->hit) {
        fputs(hit->unresolved ? "unresolved " : "miss", stdout);
        if (hit->unresolved)
            print_number(stdout, hit->t);
        putchar('\n');
        return;
    }
    print_number(stdout, is_ray ? hit->t : hit->distance);
    for (int axis = 0; is_ray && axis < 3; axis++) {
        putchar(' ');
        print_number(stdout, hit->point[axis]);
    }
    for (int axis = 0; axis < 3; axis++) {
        putchar(' ');
        print_number(stdout, hit->normal[axis]);
    }
    printf(" %u %u %u\n", hit->component, hit->level, hit->instance);
}

static void print_binary(bool is_ray, const KrsHit *hit)
{
    double record[RECORD_OUT] = {hit->unresolved ? NAN : INFINITY};
    if (hit->hit || !is_ray) {
        record[0] = is_ray ? hit->t : hit->distance;
        memcpy(record + 1, hit->point, sizeof hit->point);
        memcpy(record + 4, hit->normal, sizeof hit->normal);
        record[7] = hit->component;
        record[8] = hit->level;
        record[9] = hit->instance;
    }
    for (int i = 0; i < RECORD_OUT; i++) {
        uint64_t bits;
        memcpy(&bits, &record[i], sizeof bits);
        bits = htole64(bits);
        fwrite(&bits, sizeof bits, 1, stdout);
    }
}

/* Answers the questions of a batch in order, up to the first failure. */
static void answer_batch(Query *query)
{
    if (query->status == KRS_OK)
        query->status = answer_kind(query, false);
    if (query->status == KRS_OK)
        query->status = answer_kind(query, true);
    for (size_t i = 0; i < query->count && query->status == KRS_OK; i++)
        if (query->options->binary)
            print_binary(query->is_ray[i], &query->answers[i]);
        else
            print_text(query->is_ray[i], &query->answers[i]);
    query->count = 0;
}

/* Adds a question; false: the numbers cannot be a point or a ray. */
static bool add_question(Query *query, const double *numbers, bool is_ray)
{
    for (int i = 0; i < (is_ray ? 6 : 3); i++)
        if (!isfinite(numbers[i]))
            return false;
    if (is_ray && numbers[3] == 0 && numbers[4] == 0 && numbers[5] == 0)
        return false;
    memcpy(query->origins[query->count], numbers, 3 * sizeof *numbers);
    memcpy(query->directions[query->count], numbers + 3, 3 * sizeof *numbers);
    query->is_ray[query->count++] = is_ray;
    if (query->count == BATCH)
        answer_batch(query);
    return true;
}

/* Reads one line, NUL-terminated, and skips blank ones. */
static bool read_line(Query *query, const char *line)
{
    double numbers[6] = {0};
    int    count      = 0;
    query->line++;
    for (;;) {
        line += strspn(line, " \t\r");
        if (*line == '\0')
            break;
        char *end;
        if (count == 6)
            return false;
        numbers[count++] = strtod(line, &end);
        if (end == line || !strchr(" \t\r", *end)) /* also finds the NUL */
            return false;
        line = end;
    }
    return count == 0 || ((count == 3 || count == 6) && add_question(query, numbers, count == 6));
}

/* Takes the lines, or the records, that are complete; returns the bytes used.  *good becomes
   false at one that makes no sense. */
static size_t take_input(Query *query, char *input, size_t length, bool *good)
{
    size_t used = 0;
    *good       = true;
    while (*good && query->options->binary && length - used >= RECORD_IN) {
        double numbers[6];
        for (int i = 0; i < 6; i++) {
            uint64_t bits;
            memcpy(&bits, input + used + 8 * (size_t)i, sizeof bits);
            bits = le64toh(bits);
            memcpy(&numbers[i], &bits, sizeof bits);
        }
        query->line++;
        *good = add_question(query, numbers, numbers[3] != 0 || numbers[4] != 0 || numbers[5] != 0);
        used += RECORD_IN;
    }
    char *newline;
    while (*good && !query->options->binary &&
           (newline = memchr(input + used, '\n', length - used))) {
        *newline   = '\0';
        bool whole = strlen(input + used) == (size_t)(newline - input) - used;
        *good      = read_line(query, input + used) && whole;
        used       = (size_t)(newline - input) + 1;
    }
    return used;
}

static KrsStatus refuse_input(const Query *query)
{
    if (query->options->binary)
        say("record %llu of standard input is not six finite numbers",
            (unsigned long long)query->line);
    else
        say("line %llu of standard input is neither a point `x y z` nor a ray `x y z dx dy dz`",
            (unsigned long long)query->line);
    return KRS_BAD_ARGUMENT;
}

/* Answers the rest after the last newline, or behind the last whole record. */
static KrsStatus finish_input(Query *query, char *input, size_t length)
{
    bool good = true;
    if (length > 0 && query->options->binary) {
        query->line++;
        good = false;
    } else if (length > 0) {
        input[length] = '\0';
        good          = read_line(query, input) && strlen(input) == length;
    }
    answer_batch(query);
    return !good && query->status == KRS_OK ? refuse_input(query) : query->status;
}

static KrsStatus answer_input(Query *query, char *input)
{
    size_t length = 0;
    for (;;) {
        ssize_t got = read(STDIN_FILENO, input + length, INPUT_SIZE - length);
        if (got < 0 && errno == EINTR)
            continue;
        if (got < 0) {
            say("cannot read standard input: %s", strerror(errno));
            return KRS_IO_ERROR;
        }
        if (got == 0)
            return finish_input(query, input, length);
        length += (size_t)got;

        bool   good;
        size_t used = take_input(query, input, length, &good);
        answer_batch(query);
        if (query->status != KRS_OK)
            return query->status;
        memmove(input, input + used, length - used);
        length -= used;
        if (length == INPUT_SIZE) { /* no line is as long as that */
            query->line++;
            good = false;
        }
        if (!good)
            return refuse_input(query);
        if (fflush(stdout) != 0)
            return KRS_OK; /* the end of every command looks at the output, and says so once */
    }
}

/* Opens the device for `--on device`. */
static KrsStatus open_device(Query *query, const KrsScene *scene)
{
    KrsStatus status = open_renderer(query->options, &query->renderer);
    if (status != KRS_OK)
        return status;
    stage_enter(STAGE_SHADERS);
    status = krs_rendering_new(query->renderer, scene, KRS_FOR_QUESTIONS, &query->rendering);
    if (status != KRS_OK)
        say_renderer(query->options, scene, query->renderer, status);
    return status;
}

KrsStatus command_query(Options *options)
{
    KrsScene *scene;
    KrsStatus status = scene_open(options, options->files.items[0], &scene);
    if (status != KRS_OK)
        return status;
    Query *query   = arena_new(options->arena, Query);
    char  *input   = arena_alloc(options->arena, INPUT_SIZE + 1, 1);
    query->options = options;
    status         = scene_state(options, scene, &query->state);
    if (status == KRS_OK && options->on_device)
        status = open_device(query, scene);
    if (status == KRS_OK) {
        stage_enter(STAGE_ANSWER);
        if (isatty(STDIN_FILENO) && !options->quiet)
            say("%s", "a line `x y z` is a point, `x y z dx dy dz` a ray; Ctrl D ends");
        status = answer_input(query, input);
    }
    krs_rendering_free(query->rendering);
    krs_renderer_free(query->renderer);
    krs_state_free(query->state);
    krs_scene_free(scene);
    return status;
}
