/*
 * programs.c: POV-Ray and surf on the same surfaces: their scenes, and processes of them.
 *
 * They are asked for the same view, one light, no shadows, no smoothing of edges, and a file
 * without compression.  POV-Ray shows the same solid; surf knows no solids, and shows the surface
 * alone where it is within the ball, from both sides.  Neither is needed for krs: what is not
 * installed is left out.
 */
#include <math.h>
#include <fcntl.h>
#include <png.h>
#include <spawn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "bench/algebraic/judge.h"

extern char **environ;

bool program_is_installed(const char *command)
{
    const char *path = getenv("PATH");
    char        file[4096];
    while (path && *path) {
        size_t length = strcspn(path, ":");
        snprintf(file, sizeof file, "%.*s/%s", (int)length, path, command);
        if (access(file, X_OK) == 0)
            return true;
        path += length + (path[length] == ':');
    }
    return false;
}

static double now_ms(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec * 1e3 + (double)now.tv_nsec * 1e-6;
}

static double milliseconds(struct timeval time)
{
    return (double)time.tv_sec * 1e3 + (double)time.tv_usec * 1e-3;
}

bool run_command(char *const *arguments, const char *output, Run *run)
{
    posix_spawn_file_actions_t actions;
    pid_t                      child;
    int                        status;
    struct rusage              usage;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 1, output, O_WRONLY | O_CREAT | O_TRUNC, 0600);
    posix_spawn_file_actions_adddup2(&actions, 1, 2);
    double start = now_ms();
    bool   began = posix_spawnp(&child, arguments[0], &actions, NULL, arguments, environ) == 0;
    posix_spawn_file_actions_destroy(&actions);
    if (!began || wait4(child, &status, 0, &usage) != child)
        return false;
    run->wall   = now_ms() - start;
    run->cpu    = milliseconds(usage.ru_utime) + milliseconds(usage.ru_stime);
    run->memory = (double)usage.ru_maxrss / 1024;
    return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/* Reads the next number of the head, behind P6, blanks and comments. */
static bool read_number(FILE *file, int *number)
{
    char line[256];
    if (fscanf(file, "P6 ") == EOF)
        return false;
    for (int c = fgetc(file); c != EOF; c = fgetc(file)) {
        if (c == '#' && !fgets(line, sizeof line, file))
            return false;
        if (c >= '0' && c <= '9') {
            ungetc(c, file);
            return fscanf(file, "%d", number) == 1;
        }
    }
    return false;
}

bool read_picture(const char *path, double *coverage, bool *seen)
{
    FILE         *file  = fopen(path, "rb");
    int           width = 0, height = 0, most = 0;
    unsigned char pixel[3];
    size_t        bright = 0;
    if (!file)
        return false;
    bool good = read_number(file, &width) && read_number(file, &height) &&
                read_number(file, &most) && width == WIDTH && height == HEIGHT && most == 255;
    good = good && fgetc(file) == '\n';
    for (int i = 0; i < WIDTH * HEIGHT && good; i++) {
        good      = fread(pixel, 1, 3, file) == 3;
        bool here = pixel[0] + pixel[1] + pixel[2] > 0;
        bright += here;
        if (seen && i % WIDTH % STRIDE == 0 && i / WIDTH % STRIDE == 0)
            *seen++ = here;
    }
    fclose(file);
    *coverage = (double)bright / (WIDTH * HEIGHT);
    return good;
}

void read_png(const char *path, double *coverage, bool *seen)
{
    png_image image = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(&image, path))
        give_up(path, "cannot read it");
    image.format  = PNG_FORMAT_RGB;
    png_byte *rgb = malloc(PNG_IMAGE_SIZE(image));
    size_t    lit = 0, width = image.width, pixels = width * image.height;
    if (!rgb || !png_image_finish_read(&image, NULL, rgb, 0, NULL))
        give_up(path, "cannot read it");
    for (size_t i = 0; i < pixels; i++) {
        bool here = rgb[3 * i] + rgb[3 * i + 1] + rgb[3 * i + 2] > 0;
        lit += here;
        if (seen && i % width % STRIDE == 0 && i / width % STRIDE == 0)
            *seen++ = here;
    }
    free(rgb);
    *coverage = (double)lit / (double)pixels;
}

static bool judge_file(const char *path, const Subject *subject, const View *view, Drawn drawn,
                       Run *run)
{
    static bool seen[SEEN_ROWS][SEEN_COLUMNS];
    if (!read_picture(path, &run->coverage, &seen[0][0]))
        return false;
    run->judgement = judge(subject, view, drawn, seen);
    return true;
}

static FILE *create(const char *path)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        give_up(path, "cannot write it");
    return file;
}

/* ---- POV-Ray ---- */

static void write_vector(FILE *file, const char *name, const double v[3], double times)
{
    fprintf(file, "%s <%.17g, %.17g, %.17g> ", name, times * v[0], times * v[1], times * v[2]);
}

/* Finds where the last base before `end` begins: a letter or a parenthesis. */
static const char *find_base(const char *end)
{
    int open = 0;
    do {
        end--;
        open += (*end == ')') - (*end == '(');
    } while (open > 0);
    return end;
}

/* Powers of coordinates and parentheses written out: functions of POV-Ray have none. */
static void write_products(FILE *file, const char *from, const char *to)
{
    for (const char *at = from; at < to; at++) {
        if (*at != '^') {
            fputc(*at, file);
            continue;
        }
        const char *base = find_base(at), *end = at;
        for (long times = strtol(at + 1, (char **)&at, 10); times > 1; times--) {
            fputc('*', file);
            write_products(file, base, end);
        }
        at--;
    }
}

/* Writes the coefficients of total degree n and less, by falling powers of x, then y, then z. */
static void write_coefficients(FILE *file, const Subject *subject)
{
    Polynomial p = polynomial_read(subject->text, definitions);
    int        n = subject->degree;
    fprintf(file, "intersection { sphere { 0, %.17g } poly { %d, <", subject->radius, n);
    for (int i = n; i >= 0; i--)
        for (int j = n - i; j >= 0; j--)
            for (int k = n - i - j; k >= 0; k--)
                fprintf(file, "%s%.17g", i == n ? "" : ",\n", p.c[i][j][k]);
    fprintf(file, "> } bounded_by { sphere { 0, %.17g } }\n", subject->radius);
}

static void write_pov(const char *path, const Subject *subject, const View *view, bool expanded)
{
    FILE *file = create(path);
    fprintf(file, "#version 3.7;\nglobal_settings { assumed_gamma 1 max_trace_level 1 }\n"
                  "background { color rgb 0 }\ncamera { orthographic ");
    write_vector(file, "location", view->back, view->distance);
    write_vector(file, "direction", view->back, -1);
    write_vector(file, "up", view->up, view->height);
    write_vector(file, "right", view->right, view->height * WIDTH / HEIGHT);
    fprintf(file, "}\nlight_source { ");
    write_vector(file, "", view->back, 1000);
    fprintf(file, "color rgb 1 shadowless }\n");
    if (expanded) {
        write_coefficients(file, subject);
    } else {
        fprintf(file, "isosurface { function { ");
        write_products(file, subject->text, subject->text + strlen(subject->text));
        fprintf(file,
                " }\ncontained_by { sphere { 0, %.17g } }\n"
                "evaluate 1, 1.2, 0.95 accuracy 1e-4\n",
                subject->radius);
    }
    fprintf(file, "pigment { color rgb 0.8 } finish { ambient 0.1 diffuse 0.8 }\n}\n");
    fclose(file);
}

/* "Trace Time: ... (1.234 seconds)", and behind it "using 2 thread(s) with 1.2 CPU-seconds". */
static double read_trace_time(const char *path)
{
    char   line[1024];
    double seconds = 0;
    FILE  *file    = fopen(path, "rb");
    while (file && fgets(line, sizeof line, file)) {
        const char *with = strstr(line, "CPU-seconds") ? strstr(line, "with ") : NULL;
        if (with)
            seconds = strtod(with + strlen("with "), NULL);
    }
    if (file)
        fclose(file);
    return seconds * 1e3;
}

static bool run_pov(const char *folder, const Subject *subject, const View *view, bool expanded,
                    Run *run)
{
    char scene[512], input[520], output[520], said[512];
    snprintf(scene, sizeof scene, "%s/scene.pov", folder);
    snprintf(input, sizeof input, "+I%s", scene);
    snprintf(output, sizeof output, "+O%s/pov.ppm", folder);
    snprintf(said, sizeof said, "%s/pov.txt", folder);
    write_pov(scene, subject, view, expanded);
    char *const arguments[] = {"povray", input, output, "+FP", "+W1280", "+H720",
                               "-D",     "-A",  "-P",   "-V",  "+WT2",   NULL};
    if (!run_command(arguments, said, run) ||
        !judge_file(output + 2, subject, view, CUT_SOLID, run))
        return false;
    run->frame = read_trace_time(said);
    return true;
}

static bool run_pov_poly(const Program *program, const char *folder, const Subject *subject,
                         const View *view, Run *run)
{
    (void)program;
    return run_pov(folder, subject, view, true, run);
}

static bool run_pov_isosurface(const Program *program, const char *folder, const Subject *subject,
                               const View *view, Run *run)
{
    (void)program;
    return run_pov(folder, subject, view, false, run);
}

/* ---- surf ---- */

/* Writes a text with u, v, w in the place of x, y, z, which are those of the picture. */
static void write_rotated(FILE *file, const char *text)
{
    for (; *text; text++)
        fputc(*text >= 'x' && *text <= 'z' ? *text - 'x' + 'u' : *text, file);
}

/* Its window is 20 units high, its rays are parallel. */
static void write_surf(const char *path, const char *picture, const Subject *subject,
                       const View *view)
{
    FILE  *file = create(path);
    double unit = view->height / 20;
    fprintf(file, "width = %d; height = %d;\n", WIDTH, HEIGHT);
    for (int i = 0; i < 3; i++)
        fprintf(file, "poly %c = (%.17g)*x + (%.17g)*y + (%.17g)*z;\n", "uvw"[i],
                view -> right[i] * unit, view -> up[i] * unit, view -> back[i] * unit);
    for (const Definition *d = definitions; d->name; d++) {
        fprintf(file, "poly %s = ", d->name);
        write_rotated(file, d->text);
        fprintf(file, ";\n");
    }
    fprintf(file, "surface = ");
    write_rotated(file, subject->text);
    fprintf(file,
            ";\nperspective = parallel;\nclip = sphere;\nradius = %.17g;\n"
            "clip_front = 100;\nclip_back = -100;\n"
            "background_red = 0;\nbackground_green = 0;\nbackground_blue = 0;\n"
            "ambient = 10;\ndiffuse = 80;\nreflected = 0;\ntransmitted = 0;\n"
            "light1_x = 0;\nlight1_y = 0;\nlight1_z = 1000;\nlight1_vol = 100;\n"
            "surface_red = 200;\nsurface_green = 200;\nsurface_blue = 200;\n"
            "inside_red = 200;\ninside_green = 200;\ninside_blue = 200;\n"
            "draw_surface;\nfilename = \"%s\";\ncolor_file_format = ppm;\n"
            "save_color_image;\n",
            subject->radius / unit, picture);
    fclose(file);
}

static bool run_surf(const Program *program, const char *folder, const Subject *subject,
                     const View *view, Run *run)
{
    char script[512], picture[512], said[512];
    snprintf(script, sizeof script, "%s/scene.pic", folder);
    snprintf(picture, sizeof picture, "%s/surf.ppm", folder);
    snprintf(said, sizeof said, "%s/surf.txt", folder);
    write_surf(script, picture, subject, view);
    char *const arguments[] = {(char *)program->command, script, NULL};
    return run_command(arguments, said, run) &&
           judge_file(picture, subject, view, OPEN_SURFACE, run);
}

const Program programs[] = {
    {"POV-Ray `poly`", "povray", run_pov_poly, 35, 1, false},
    {"POV-Ray `isosurface`", "povray", run_pov_isosurface, 6, 6, true},
    {"surf", "surf-alggeo-nox", run_surf, 30, 1, false},
};
const size_t program_count = sizeof programs / sizeof *programs;
