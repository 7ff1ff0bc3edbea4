/*
 * trees.c: the tree of bench/scenes/tree.krs, by krs as a sequence and by POV-Ray branch by branch.
 *
 * POV-Ray gets the least that passes for a branch, two cylinders and two balls, where krs draws an
 * arc with round ends.  Both have one light, at the eye, and nothing else.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "bench/algebraic/processes.h"

enum { WRITTEN_LEVELS = 16, MAX_BRANCHES = 1 << WRITTEN_LEVELS, TEXT_ROOM = 8192 };

static const double DEGREE = 0.017453292519943295;
static const double EYE[3] = {0.15, 1, 9}, TARGET[3] = {0.15, 1.55, 0}, FOV = 19.5;

/* ---- the tree, a second time ---- */

typedef struct Fork { /* where a branch begins, its direction there, the side to which it bends */
    double at[3], ahead[3], lateral[3];
} Fork;

typedef struct Limb {
    double points[3][3], radius; /* its ends, and the middle of its arc */
} Limb;

static double bend_of(int i) { return (i == 0 ? 5 : 14) * DEGREE; }
static double reach_of(int i) { return i == 0 ? 0.7 : pow(0.72, i); }
static double width_of(int i) { return i == 0 ? 0.066 : 0.075 * pow(0.75, i); }

/* A point of the arc, by the angle of its chord and its length. */
static void point_of(const Fork *fork, double angle, double length, double point[3])
{
    for (int k = 0; k < 3; k++)
        point[k] = fork->at[k] +
                   length * (cos(angle) * fork->ahead[k] + sin(angle) * fork->lateral[k]);
}

static Fork next_fork(const Fork *below, int i)
{
    Fork   fork;
    double angle = 2 * bend_of(i), turn = 100 * DEGREE, left[3];
    point_of(below, bend_of(i), reach_of(i), fork.at);
    for (int k = 0; k < 3; k++) {
        fork.ahead[k] = cos(angle) * below->ahead[k] + sin(angle) * below->lateral[k];
        left[k]       = cos(angle) * below->lateral[k] - sin(angle) * below->ahead[k];
    }
    for (int k = 0; k < 3; k++) {
        int m = (k + 1) % 3, n = (k + 2) % 3;
        fork.lateral[k] = cos(turn) * left[k] +
                          sin(turn) * (fork.ahead[m] * left[n] - fork.ahead[n] * left[m]);
    }
    return fork;
}

static void mirror_point(const Fork *fork, const double p[3], double image[3])
{
    double normal[3], above = 0;
    for (int k = 0; k < 3; k++) {
        normal[k] = -sin(9 * DEGREE) * fork->ahead[k] - cos(9 * DEGREE) * fork->lateral[k];
        above += normal[k] * (p[k] - fork->at[k]);
    }
    for (int k = 0; k < 3; k++)
        image[k] = p[k] - 2 * above * normal[k];
}

/* Makes the branches from the twigs down: a mirror at each fork, and the branch below it. */
static size_t grow(Limb limbs[MAX_BRANCHES])
{
    Fork   forks[WRITTEN_LEVELS] = {{.ahead   = {-sin(5 * DEGREE), cos(5 * DEGREE), 0},
                                     .lateral = {cos(5 * DEGREE), sin(5 * DEGREE), 0}}};
    size_t count                 = 0;
    for (int i = 1; i < WRITTEN_LEVELS; i++)
        forks[i] = next_fork(&forks[i - 1], i - 1);
    for (int i = WRITTEN_LEVELS - 1; i >= 0; i--) {
        Limb  *limb = &limbs[count++];
        double half = 0.5 * bend_of(i);
        point_of(&forks[i], 0, 0, limb->points[0]);
        point_of(&forks[i], half, 0.5 * reach_of(i) / cos(half), limb->points[1]);
        point_of(&forks[i], 2 * half, reach_of(i), limb->points[2]);
        limb->radius = width_of(i);
        for (size_t k = 0, below = count; k < below && i > 0; k++, count++) {
            limbs[count].radius = limbs[k].radius;
            for (int end = 0; end < 3; end++)
                mirror_point(&forks[i], limbs[k].points[end], limbs[count].points[end]);
        }
    }
    return count;
}

/* ---- POV-Ray ---- */

static size_t write_pov_tree(const char *path)
{
    FILE *file  = fopen(path, "wb");
    Limb *limbs = calloc(MAX_BRANCHES, sizeof *limbs);
    if (!file || !limbs)
        give_up(path, "cannot write it");
    size_t count = grow(limbs);
    double rise = TARGET[1] - EYE[1], back = TARGET[2] - EYE[2], length = hypot(rise, back);
    fprintf(file,
            "#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level 1 }\n"
            "background { color rgb 0 }\n"
            "#default { pigment { color rgb 0.8 } finish { ambient 0.1 diffuse 0.8 } }\n"
            "camera { location <%g, %g, %g> right <%.17g, 0, 0> up <0, %.17g, %.17g> "
            "direction <0, %.17g, %.17g> }\n"
            "light_source { <%g, %g, %g> color rgb 1 shadowless }\n",
            EYE[0], EYE[1], EYE[2], (double)WIDTH / HEIGHT, -back / length, rise / length,
            0.5 / tan(0.5 * FOV * DEGREE) * rise / length,
            0.5 / tan(0.5 * FOV * DEGREE) * back / length, EYE[0], EYE[1], EYE[2]);
    for (size_t i = 0; i < 2 * count; i++) {
        const double *a = limbs[i / 2].points[i % 2], *b = limbs[i / 2].points[i % 2 + 1];
        double        radius = limbs[i / 2].radius;
        fprintf(file,
                "cylinder { <%.9g,%.9g,%.9g>, <%.9g,%.9g,%.9g>, %.9g }\n"
                "sphere { <%.9g,%.9g,%.9g>, %.9g }\n",
                a[0], a[1], a[2], b[0], b[1], b[2], radius, b[0], b[1], b[2], radius);
    }
    fclose(file);
    free(limbs);
    return count;
}

static void run_pov_tree(const char *folder, Run *run)
{
    char input[512], output[512], said[512];
    snprintf(input, sizeof input, "+I%s/tree.pov", folder);
    snprintf(output, sizeof output, "+O%s/tree.ppm", folder);
    snprintf(said, sizeof said, "%s/tree.txt", folder);
    char *const arguments[] = {"povray", input, output, "+FP", "+W1280", "+H720",
                               "-D",     "-A",  "-P",   "-V",  "+WT2",   NULL};
    if (!run_command(arguments, said, run) || !read_picture(output + 2, &run->coverage, NULL))
        give_up("povray", "it failed");
}

/* ---- krs ---- */

static void write_krs_tree(int levels, char text[TEXT_ROOM])
{
    static const char path[] = "bench/scenes/tree.krs";
    FILE             *file   = fopen(path, "rb");
    if (!file)
        give_up(path, "cannot read it");
    size_t length = fread(text, 1, TEXT_ROOM / 2, file);
    fclose(file);
    snprintf(text + length, TEXT_ROOM - length,
             "\nshow tree(%d).paint(bark);\n"
             "camera { eye: [%g, %g, %g], target: [%g, %g, %g], fov: %gdeg }\n"
             "light lamp { position: [%g, %g, %g], intensity: 200, shadow: false }\n"
             "sky { zenith: #000000, horizon: #000000, ground: #000000 }\n"
             "image { size: [%d, %d] }\n",
             levels, EYE[0], EYE[1], EYE[2], TARGET[0], TARGET[1], TARGET[2], FOV, EYE[0], EYE[1],
             EYE[2], WIDTH, HEIGHT);
}

static void run_krs_tree(const char *krs, const char *folder, int levels, Run *run)
{
    char text[TEXT_ROOM], picture[512];
    write_krs_tree(levels, text);
    snprintf(picture, sizeof picture, "%s/krs.png", folder);
    run_krs(krs, folder, "trees", text, NULL, run);
    read_png(picture, &run->coverage, NULL);
}

/* ---- both ---- */

static const int levels[] = {28, WRITTEN_LEVELS};

void trees_run(Trees *trees, const char *krs, size_t repeats)
{
    char folder[FOLDER_ROOM], path[512];
    folder_make(folder);
    snprintf(path, sizeof path, "%s/tree.pov", folder);
    trees->branches = write_pov_tree(path);
    for (size_t repeat = 0; repeat <= repeats; repeat++) {
        Run run = {0};
        for (int i = 0; i < 2; i++) {
            run_krs_tree(krs, folder, levels[i], &run);
            if (repeat > 0) /* the first fills the cache */
                runs_take(&trees->ours[i], &run);
        }
        if (repeat > 0) {
            run_pov_tree(folder, &run);
            runs_take(&trees->written, &run);
        }
    }
    folder_remove(folder);
}

static void print_tree(const char *name, size_t branches, Runs *runs, double krs_cpu)
{
    runs_settle(runs);
    say("| %s | %zu | %.0f | %.0f | %.0f | %.2f | %.1f %% |\n", name, branches, runs->median.wall,
        runs->median.cpu, runs->median.memory, runs->median.cpu / krs_cpu,
        100 * runs->median.coverage);
}

void trees_print(Trees *trees)
{
    say("\n| tree | branches | wall ms | cpu ms | MB | cpu, of 28 levels | coverage |\n"
        "| --- | --- | --- | --- | --- | --- | --- |\n");
    runs_settle(&trees->ours[0]);
    double cpu = trees->ours[0].median.cpu;
    for (int i = 0; i < 2; i++) {
        char name[32];
        snprintf(name, sizeof name, "krs, %d levels", levels[i]);
        print_tree(name, ((size_t)1 << levels[i]) - 1, &trees->ours[i], cpu);
    }
    print_tree("POV-Ray, written out", trees->branches, &trees->written, cpu);
}
