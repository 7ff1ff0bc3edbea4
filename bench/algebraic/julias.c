/*
 * julias.c: a Julia set of the quaternions, by krs and by POV-Ray's `julia_fractal`.
 *
 * Both show the points whose orbit has not escaped after as many steps; POV-Ray counts the point
 * itself as one.  Pixels are held against walks along their rays in steps of half a pixel, by the
 * orbits of the points there.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "bench/algebraic/judge.h"
#include "bench/algebraic/processes.h"

enum { STEPS = 8, PLACES = 2048 };

static const double C[4]   = {-0.083, 0, -0.83, -0.025};
static const double WINDOW = 2.6, REACH = 1.6; /* of the picture upwards; of the set, and more */

/* ---- what there is ---- */

static double norm4(const double q[4])
{
    return sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

static bool is_inside(double x, double y, double z)
{
    double escape = 0.5 + sqrt(0.25 + norm4(C)), q[4] = {x, y, z, 0};
    for (int i = 0; i < STEPS; i++) {
        double real = q[0];
        q[0]        = real * real - q[1] * q[1] - q[2] * q[2] - q[3] * q[3] + C[0];
        for (int k = 1; k < 4; k++)
            q[k] = 2 * real * q[k] + C[k];
        if (norm4(q) > escape)
            return false;
    }
    return true;
}

static bool is_hit(int x, int y)
{
    double unit   = WINDOW / HEIGHT;
    double across = (0.5 * WIDTH - x - 0.5) * unit, up = (0.5 * HEIGHT - y - 0.5) * unit;
    for (int i = 0; i < PLACES; i++)
        if (is_inside(across, up, REACH * (2.0 * i / PLACES - 1)))
            return true;
    return false;
}

/* Tells whether the pixel or a neighbour of it should show what the picture does. */
static bool is_near(int x, int y, bool seen)
{
    for (int i = 0; i < 9; i++)
        if (is_hit(x + i % 3 - 1, y + i / 3 - 1) == seen)
            return true;
    return false;
}

static Judgement judge_julia(bool seen[SEEN_ROWS][SEEN_COLUMNS])
{
    Judgement judgement = {0};
    for (int y = 0; y < SEEN_ROWS; y++)
        for (int x = 0; x < SEEN_COLUMNS; x++) {
            bool hit = is_hit(x * STRIDE, y * STRIDE);
            judgement.asked++;
            judgement.missed += hit && !seen[y][x];
            judgement.extra += !hit && seen[y][x];
            judgement.apart += hit != seen[y][x] && !is_near(x * STRIDE, y * STRIDE, seen[y][x]);
        }
    return judgement;
}

/* ---- the programs ---- */

static void write_pov_julia(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        give_up(path, "cannot write it");
    fprintf(file,
            "#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level 1 }\n"
            "background { color rgb 0 }\n"
            "camera { orthographic location <0, 0, -6> direction <0, 0, 1> "
            "up <0, %.17g, 0> right <%.17g, 0, 0> }\n"
            "light_source { <0, 0, -1000> color rgb 1 shadowless }\n"
            "julia_fractal { <%g, %g, %g, %g> quaternion sqr max_iteration %d precision 40\n"
            "pigment { color rgb 0.8 } finish { ambient 0.1 diffuse 0.8 } }\n",
            WINDOW, -WINDOW * WIDTH / HEIGHT, C[0], C[1], C[2], C[3], STEPS + 1);
    fclose(file);
}

static void run_pov_julia(const char *folder, bool seen[SEEN_ROWS][SEEN_COLUMNS], Run *run)
{
    char input[512], output[512], said[512];
    snprintf(input, sizeof input, "+I%s/julia.pov", folder);
    snprintf(output, sizeof output, "+O%s/julia.ppm", folder);
    snprintf(said, sizeof said, "%s/julia.txt", folder);
    write_pov_julia(input + 2);
    char *const arguments[] = {"povray", input, output, "+FP", "+W1280", "+H720",
                               "-D",     "-A",  "-P",   "-V",  "+WT2",   NULL};
    if (!run_command(arguments, said, run) ||
        !read_picture(output + 2, &run->coverage, &seen[0][0]))
        give_up("povray", "it failed");
}

static void run_krs_julia(const char *krs, const char *folder, bool seen[SEEN_ROWS][SEEN_COLUMNS],
                          Run *run)
{
    char text[1024], picture[512];
    snprintf(text, sizeof text,
             "show julia(c: [%g, %g, %g, %g], power: 2, iterations: %d);\n"
             "camera { eye: [0, 0, -6], projection: \"orthographic\", height: %.17g }\n"
             "light sun { direction: [0, 0, -1], shadow: false }\n"
             "sky { zenith: #000000, horizon: #000000, ground: #000000 }\n"
             "image { size: [%d, %d] }\n",
             C[0], C[1], C[2], C[3], STEPS, WINDOW, WIDTH, HEIGHT);
    snprintf(picture, sizeof picture, "%s/krs.png", folder);
    run_krs(krs, folder, "julia", text, NULL, run);
    read_png(picture, &run->coverage, &seen[0][0]);
}

void julias_run(Julias *julias, const char *krs, size_t repeats)
{
    static bool seen[SEEN_ROWS][SEEN_COLUMNS];
    char        folder[FOLDER_ROOM];
    Run         run = {0};
    folder_make(folder);
    for (size_t repeat = 0; repeat <= repeats; repeat++) {
        run_krs_julia(krs, folder, seen, &run);
        if (repeat > 0) { /* the first fills the cache */
            runs_take(&julias->ours, &run);
            julias->judged[0] = repeat == 1 ? judge_julia(seen) : julias->judged[0];
            run_pov_julia(folder, seen, &run);
            runs_take(&julias->pov, &run);
            julias->judged[1] = repeat == 1 ? judge_julia(seen) : julias->judged[1];
        }
    }
    folder_remove(folder);
}

static void print_julia(const char *name, Runs *runs, double krs_cpu, const Judgement *judged)
{
    runs_settle(runs);
    say("| %s | %.0f | %.0f | %.0f | %.2f | %.1f %% | %zu / %zu / %zu |\n", name, runs->median.wall,
        runs->median.cpu, runs->median.memory, runs->median.cpu / krs_cpu,
        100 * runs->median.coverage, judged->missed, judged->extra, judged->apart);
}

void julias_print(Julias *julias)
{
    say("\n| Julia set | wall ms | cpu ms | MB | cpu, of ours | coverage "
        "| missed / extra / apart |\n| --- | --- | --- | --- | --- | --- | --- |\n");
    runs_settle(&julias->ours);
    print_julia("krs", &julias->ours, julias->ours.median.cpu, &julias->judged[0]);
    print_julia("POV-Ray `julia_fractal`", &julias->pov, julias->ours.median.cpu,
                &julias->judged[1]);
}
