/*
 * essl.c: scenes as ESSL 3.00, on a driver of OpenGL ES.
 *
 * Each example, and random scenes, are compiled by the driver behind EGL (Mesa's llvmpipe where there is no other) and
 * evaluated at points in the box that the scene fills.  Distances are held against the double-precision evaluator.
 */
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GLES3/gl3.h>
#include <glob.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "krs/krs.h"
#include "tests/oracle/random_scene.h"
#include "tests/support/scattered.h"

enum { ACROSS = 32, POINTS = ACROSS * ACROSS, RANDOM_SCENES = 24 };

/* ---- the driver ---- */

static EGLDisplay display;

/* A context without a window. */
static int driver_open(void **state)
{
    const EGLint attributes[] = {EGL_CONTEXT_MAJOR_VERSION, 3, EGL_NONE};
    EGLContext   context;
    (void)state;
    display = eglGetPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, NULL);
    if (!eglInitialize(display, NULL, NULL) || !eglBindAPI(EGL_OPENGL_ES_API))
        return -1;
    context = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
    return eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) &&
                   strstr((const char *)glGetString(GL_EXTENSIONS), "GL_EXT_color_buffer_float")
               ? 0
               : -1;
}

static int driver_close(void **state)
{
    (void)state;
    return eglTerminate(display) ? 0 : -1;
}

static GLuint compile(GLenum stage, const char *const *parts, GLsizei count)
{
    GLuint shader = glCreateShader(stage);
    GLint  good;
    char   log[4096];
    glShaderSource(shader, count, parts, NULL);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    glGetShaderInfoLog(shader, sizeof log, NULL, log);
    if (!good)
        fail_msg("%s", log);
    return shader;
}

/* What a pixel has of the point p: the distance; and the roughness of what is nearest. */
#define DISTANCE "vec4(krs_distance(p), 0.5, 0.0, 1.0)"
#define ALL      "vec4(krs_distance(p), krs_surface(p, p, 0.0).roughness, 0.0, 1.0)"

/* Whose pixels have that of the points of a texture. */
static GLuint link_program(const char *scene, const char *what)
{
    const char *const vertex[]   = {"#version 300 es\n"
                                      "void main()\n{\n"
                                      "    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);\n"
                                      "    gl_Position = vec4(4.0 * corner - 1.0, 0.0, 1.0);\n}\n"};
    const char *const fragment[] = {
        "#version 300 es\nprecision highp float;\nprecision highp int;\n"
        "uniform highp sampler2D points;\nout vec4 found;\n",
        scene,
        "void main()\n{\n"
        "    krs_prepare();\n"
        "    vec3 p = texelFetch(points, ivec2(gl_FragCoord.xy), 0).xyz;\n"
        "    found = ",
        what, ";\n}\n"};
    GLuint program = glCreateProgram(), stages[2] = {compile(GL_VERTEX_SHADER, vertex, 1),
                                                     compile(GL_FRAGMENT_SHADER, fragment, 5)};
    GLint  good;
    for (int i = 0; i < 2; i++) {
        glAttachShader(program, stages[i]);
        glDeleteShader(stages[i]);
    }
    glLinkProgram(program);
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    assert_true(good);
    glUseProgram(program);
    return program;
}

/* Returns a texture of a uniform's, from texels row by row. */
static GLuint bind_texture(GLuint program, GLuint unit, const char *name, GLint kept, GLenum format,
                           GLenum type, GLsizei width, GLsizei height, const void *texels)
{
    GLuint texture;
    glGenTextures(1, &texture);
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, kept, width, height, 0, format, type, texels);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glUniform1i(glGetUniformLocation(program, name), (GLint)unit);
    return texture;
}

/* ---- a scene on the driver ---- */

static size_t rows_of(size_t texels)
{
    return (texels + KRS_TEXTURE_WIDTH - 1) / KRS_TEXTURE_WIDTH;
}

static void bind_tables(GLuint program, const KrsState *state, const KrsScene *scene,
                        GLuint textures[2])
{
    const size_t rows = rows_of(krs_table_rows(scene)), cells = rows_of(krs_table_cells(scene));
    float(*row_texels)[4]     = calloc(rows * KRS_TEXTURE_WIDTH + 1, sizeof *row_texels);
    uint32_t(*cell_texels)[2] = calloc(cells * KRS_TEXTURE_WIDTH + 1, sizeof *cell_texels);
    krs_state_tables(state, row_texels, cell_texels);
    textures[0] = bind_texture(program, 1, "krs_rows", GL_RGBA32F, GL_RGBA, GL_FLOAT,
                               KRS_TEXTURE_WIDTH, (GLsizei)rows, row_texels);
    textures[1] = bind_texture(program, 2, "krs_cells", GL_RG32UI, GL_RG_INTEGER, GL_UNSIGNED_INT,
                               KRS_TEXTURE_WIDTH, (GLsizei)cells, cell_texels);
    free(row_texels);
    free(cell_texels);
}

static GLuint bind_parameters(GLuint program, const KrsState *state, const KrsScene *scene)
{
    const size_t slots      = krs_parameter_slots(scene);
    float(*block)[4]        = calloc(slots, sizeof *block);
    const GLuint block_name = glGetUniformBlockIndex(program, "KrsParameters");
    GLuint       buffer;
    krs_state_parameters(state, block);
    glGenBuffers(1, &buffer);
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, buffer);
    glBufferData(GL_UNIFORM_BUFFER, (GLsizeiptr)(slots * sizeof *block), block, GL_STATIC_DRAW);
    if (block_name != GL_INVALID_INDEX)
        glUniformBlockBinding(program, block_name, 0);
    free(block);
    return buffer;
}

/* Draws a pixel for each point into floats. */
static void draw(float (*found)[4])
{
    GLuint target, framebuffer;
    glActiveTexture(GL_TEXTURE3);
    glGenTextures(1, &target);
    glBindTexture(GL_TEXTURE_2D, target);
    glTexStorage2D(GL_TEXTURE_2D, 1, GL_RGBA32F, ACROSS, ACROSS);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target, 0);
    assert_int_equal(glCheckFramebufferStatus(GL_FRAMEBUFFER), GL_FRAMEBUFFER_COMPLETE);
    glViewport(0, 0, ACROSS, ACROSS);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glReadPixels(0, 0, ACROSS, ACROSS, GL_RGBA, GL_FLOAT, found);
    assert_int_equal(glGetError(), GL_NO_ERROR);
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &target);
}

static void evaluate(const KrsState *state, const KrsScene *scene, const char *what,
                     const float (*points)[4], float (*found)[4])
{
    GLuint textures[3], buffer, program;
    char  *text;
    assert_int_equal(krs_text(scene, KRS_TARGET_ESSL, NULL, &text), KRS_OK);
    program = link_program(text, what);
    free(text);
    textures[0] = bind_texture(program, 0, "points", GL_RGBA32F, GL_RGBA, GL_FLOAT, ACROSS, ACROSS,
                               points);
    bind_tables(program, state, scene, textures + 1);
    buffer = bind_parameters(program, state, scene);
    draw(found);
    glDeleteTextures(3, textures);
    glDeleteBuffers(1, &buffer);
    glDeleteProgram(program);
}

/* ---- what is compared ---- */

/* Returns the points where a scene's distances differ by more than a ten-thousandth of the numbers
   that are added.  Of what is far away in a table the driver only knows a bound nearer to 0.
   `planted` multiplies what the driver says: 1, except to show that a fault is found. */
static size_t count_wrong(const char *name, KrsScene *scene, const char *what, float planted)
{
    static float  points[POINTS][4], found[POINTS][4];
    static double same[POINTS][3], distances[POINTS];
    KrsState     *state;
    Random        random = {77};
    size_t        wrong = 0, equal = 0;
    double        worst = 0;
    assert_int_equal(krs_state_new(scene, &state), KRS_OK);
    scatter(scene, &random, points, POINTS);
    for (size_t i = 0; i < POINTS; i++)
        for (int k = 0; k < 3; k++)
            same[i][k] = points[i][k];
    krs_distance(state, (const double(*)[3])same, POINTS, distances);
    evaluate(state, scene, what, (const float(*)[4])points, found);
    for (size_t i = 0; i < POINTS; i++) {
        double size = 1 + fabs(same[i][0]) + fabs(same[i][1]) + fabs(same[i][2]) +
                      fabs(distances[i]);
        double off    = (planted * found[i][0] - distances[i]) / size;
        bool   bounds = krs_table_cells(scene) > 0 && off * distances[i] < 0 &&
                      found[i][0] * distances[i] > 0;
        worst = fmax(worst, bounds ? 0 : fabs(off));
        equal += fabs(off) <= 1e-4;
        wrong += !(fabs(off) <= 1e-4 || bounds) || !(found[i][1] >= 0 && found[i][1] <= 1);
    }
    wrong += equal < POINTS / 2;
    if (wrong && planted == 1)
        print_message("# %s: %zu points differ, by %.2g at most\n", name, wrong, worst);
    krs_state_free(state);
    return wrong;
}

static void examples_agree(void **context)
{
    glob_t found;
    size_t wrong = 0;
    (void)context;
    assert_int_equal(glob("examples/*.krs", 0, NULL, &found), 0);
    assert_true(found.gl_pathc > 30);
    for (size_t i = 0; i < found.gl_pathc; i++) {
        KrsScene *scene;
        assert_int_equal(krs_compile_file(found.gl_pathv[i], NULL, &scene), KRS_OK);
        wrong += count_wrong(found.gl_pathv[i], scene, DISTANCE, 1);
        krs_scene_free(scene);
    }
    globfree(&found);
    assert_int_equal(wrong, 0);
}

static void random_scenes_agree(void **context)
{
    size_t wrong = 0, compiled = 0;
    (void)context;
    for (uint64_t i = 0; i < RANDOM_SCENES; i++) {
        Random    random = {i + 5000};
        SceneText text   = {.length = 0};
        KrsScene *scene;
        write_random_scene(&text, &random, vec(0, 0, 0), 1);
        if (krs_compile_text(text.bytes, text.length, "scene.krs", NULL, &scene) != KRS_OK)
            continue;
        compiled++;
        const size_t here = count_wrong("a random scene", scene, ALL, 1);
        if (here)
            print_message("%s\n", text.bytes);
        wrong += here;
        krs_scene_free(scene);
    }
    assert_int_equal(wrong, 0);
    assert_true(compiled >
                RANDOM_SCENES * 9 / 10); /* copies of some are too large for their cells */
}

static void a_planted_fault_is_found(void **context)
{
    static const char text[] = "show sphere(1);";
    KrsScene         *scene;
    (void)context;
    assert_int_equal(krs_compile_text(text, strlen(text), "scene.krs", NULL, &scene), KRS_OK);
    assert_int_equal(count_wrong("a sphere", scene, ALL, 1), 0);
    assert_true(count_wrong("a sphere", scene, ALL, 1.01f) > POINTS / 2);
    krs_scene_free(scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_planted_fault_is_found),
        cmocka_unit_test(examples_agree),
        cmocka_unit_test(random_scenes_agree),
    };
    return cmocka_run_group_tests_name("scenes as ESSL", tests, driver_open, driver_close);
}
