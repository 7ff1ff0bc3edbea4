/*
 * service.c: how long answers to an editor take, in a text of 5,000 lines.
 *
 *     service [LINES]
 *
 * The text has definitions, functions, comprehensions, materials and shapes in turn.  Before each question a letter is typed
 * in its middle, so that all is read anew; and a letter that makes a mistake.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "compiler/service/service.h"

enum { REPEATS = 21 };

static double now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static char *make_text(int lines, size_t *length)
{
    char *text = NULL;
    FILE *out  = open_memstream(&text, length);
    for (int i = 0; i < lines; i += 10) {
        fprintf(out, "/// The number of part %d.\nlet size_%d = 0.5 + 0.001 * %d;\n", i, i, i);
        fprintf(out,
                "def part_%d(r, at = [0, 0, 0]) =\n    sphere(r * size_%d).move(at) |\n"
                "    box([r, r, size_%d]).rotate([0, 1, 0], 30deg).move(at + [1, 0, 0]);\n",
                i, i, i);
        fprintf(out, "material skin_%d { color: #cc%02x33, roughness: 0.4 }\n", i, i % 256);
        fprintf(out, "let row_%d = [part_%d(0.1 * k, at: [k, %d, 0]) for k in 1..4 if k != 2];\n",
                i, i, i);
        fprintf(out,
                "let all_%d = let joined = union(row_%d, blend: 0.1) in joined.paint(skin_%d);\n",
                i, i, i);
        fprintf(out, "show all_%d - cylinder(radius: size_%d / 4, height: 3);\n\n", i, i);
    }
    fclose(out);
    return text;
}

static int compare(const void *a, const void *b)
{
    const double left = *(const double *)a, right = *(const double *)b;
    return left < right ? -1 : left > right;
}

/* Times a question behind a change, and the same once more. */
static void measure(Service *service, const char *question, Utf16Position at, const char *typed)
{
    double                fresh[REPEATS], again[REPEATS];
    const Utf16Position   behind = {at.line, at.character + (uint32_t)strlen(typed)};
    const ServiceQuestion about  = {
         .path = "bench.krs", .from = behind, .to = behind, .word = "another", .definition = true};
    size_t bytes = 0;
    for (int i = 0; i < REPEATS; i++) {
        service_edit(service, "bench.krs", at, at, typed, strlen(typed));
        double      begun  = now_ms();
        const char *answer = service_answer(service, question, &about);
        fresh[i]           = now_ms() - begun;
        bytes              = answer ? strlen(answer) : 0;
        begun              = now_ms();
        service_answer(service, question, &about);
        again[i] = now_ms() - begun;
        service_edit(service, "bench.krs", at, behind, "", 0);
    }
    qsort(fresh, REPEATS, sizeof *fresh, compare);
    qsort(again, REPEATS, sizeof *again, compare);
    printf("| %s | %s | %.1f | %.1f | %.1f | %zu |\n", question + strlen("textDocument/"),
           *typed == '\n' ? "an empty line" : typed, fresh[REPEATS / 2], fresh[REPEATS - 1],
           again[REPEATS / 2], bytes);
}

int main(int argc, char **argv)
{
    static const char *const questions[] = {
#define QUESTION(name, function, capability, value) name,
#include "compiler/service/questions.def"
    };
    const int           lines   = argc > 1 ? atoi(argv[1]) : 5000;
    const Utf16Position names   = {(uint32_t)(lines / 20 * 10 + 3), 20};
    const Utf16Position between = {(uint32_t)(lines / 20 * 10 + 9), 0};
    size_t              length;
    char               *text    = make_text(lines, &length);
    Service            *service = service_new(NULL);
    if (!text || !service || !service_open(service, "bench.krs", NULL, text, length))
        return EXIT_FAILURE;
    printf("%d lines, %zu bytes; milliseconds behind a change, at most, and once more\n\n", lines,
           length);
    printf("| question | typed | median | most | again | bytes |\n| --- | --- | --- | --- | --- | "
           "--- |\n");
    for (size_t i = 0; i < sizeof questions / sizeof *questions; i++)
        measure(service, questions[i], names, "_");
    measure(service, "textDocument/completion", between, "show sphere(si");
    measure(service, "textDocument/completion", between, "show all_0.");
    measure(service, "textDocument/hover", between, "\n");
    service_free(service);
    free(text);
    return EXIT_SUCCESS;
}
