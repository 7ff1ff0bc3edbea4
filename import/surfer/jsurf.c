/*
 * jsurf.c: surfaces of SURFER and jsurf, .jsurf.
 *
 * Such a file is a list of properties, as Java writes them: an equation f of x, y, z and
 * parameters, of which f = 0 is shown within a ball; camera, lights, the colours of both sides.
 * The scene is built in the space of the equation.  SURFER's own spaces differ from it:
 *     space of the ball      = transform_matrix rotation_matrix camera_transform^-1 (camera's)
 *     space of the equation  = surface_transform_matrix 10^scale_factor (the ball's)
 * Its ball has radius 1, and its lights stand in the space of the camera.
 */
#include "import/surfer/jsurf.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "import/surfer/equation.h"
#include "import/surfer/properties.h"
#include "compiler/base/vec.h"

enum { LIGHTS = 8 };

/* ---- spaces ---- */

/* Rows of three factors and a shift. */
typedef struct Space {
    double rows[3][4];
} Space;

/* Returns a after b. */
static Space space_after(const Space *a, const Space *b)
{
    Space both;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++) {
            both.rows[i][k] = k == 3 ? a->rows[i][3] : 0;
            for (int j = 0; j < 3; j++)
                both.rows[i][k] += a->rows[i][j] * b->rows[j][k];
        }
    return both;
}

/* Applies a space; `shifted` is 1 for points, 0 for directions. */
static void space_apply(const Space *space, const double v[3], double shifted, double to[3])
{
    for (int i = 0; i < 3; i++)
        to[i] = space->rows[i][0] * v[0] + space->rows[i][1] * v[1] + space->rows[i][2] * v[2] +
                space->rows[i][3] * shifted;
}

static bool read_space(const JsurfSurface *surface, const char *key, Space *space)
{
    double numbers[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    if (!jsurf_numbers(surface, key, numbers, 16))
        return false;
    memcpy(space->rows, numbers, sizeof space->rows);
    return true;
}

/* Returns the factor by which a space is larger than another that is rotated against it at most; 0:
   not so, or mirrored.  Files have seven digits. */
static double space_factor(const Space *space)
{
    const double  CLOSE = 1e-4;
    const double *a = space->rows[0], *b = space->rows[1], *c = space->rows[2];
    double        cross[3], square = dot3(a, a), slack = CLOSE * square;
    cross3(a, b, cross);
    bool same_length = fabs(dot3(b, b) - square) <= slack && fabs(dot3(c, c) - square) <= slack;
    bool upright     = fabs(dot3(a, b)) <= slack && fabs(dot3(a, c)) <= slack &&
                   fabs(dot3(b, c)) <= slack;
    return square > 0 && same_length && upright && dot3(cross, c) > 0 ? sqrt(square) : 0;
}

static bool refuse_space(const JsurfSurface *surface, const char *key, const char *why)
{
    return import_refuse(surface->import, jsurf_line(surface, key), "`%s` %s", key, why);
}

/* Reads a rotation, whose inverse needs no division. */
static bool read_rotation(const JsurfSurface *surface, const char *key, Space *space)
{
    if (!read_space(surface, key, space))
        return false;
    return fabs(space_factor(space) - 1) < 1e-3 ||
           refuse_space(surface, key, "does more than turn and move");
}

static Space inverse_rotation(const Space *space)
{
    Space inverse;
    for (int i = 0; i < 3; i++) {
        inverse.rows[i][3] = 0;
        for (int k = 0; k < 3; k++) {
            inverse.rows[i][k] = space->rows[k][i];
            inverse.rows[i][3] -= space->rows[k][i] * space->rows[k][3];
        }
    }
    return inverse;
}

/* Reads the map from the camera's space to that of the ball, and the scale of the surface. */
static bool read_spaces(JsurfSurface *surface, Space *camera)
{
    Space  whole, rotation, own, surfaces;
    double zoom = 0;
    if (!read_rotation(surface, "transform_matrix", &whole) ||
        !read_rotation(surface, "rotation_matrix", &rotation) ||
        !read_rotation(surface, "camera_transform", &own) ||
        !read_space(surface, "surface_transform_matrix", &surfaces) ||
        !jsurf_numbers(surface, "scale_factor", &zoom, 1))
        return false;
    own           = inverse_rotation(&own);
    rotation      = space_after(&rotation, &own);
    *camera       = space_after(&whole, &rotation);
    double factor = space_factor(&surfaces), off = 0;
    for (int i = 0; i < 3; i++) {
        off = fmax(off, fabs(surfaces.rows[i][3]));
        for (int k = 0; k < 3; k++)
            off = fmax(off, i != k ? fabs(surfaces.rows[i][k]) : 0);
    }
    if (factor == 0 || off > 1e-4 * factor)
        return refuse_space(surface, "surface_transform_matrix", "does more than scale");
    surface->scale = factor * pow(10, zoom);
    return (surface->scale > 1e-6 && surface->scale < 1e6) ||
           refuse_space(surface, "scale_factor", "leads out of 1e-6 to 1e6");
}

/* ---- looks ---- */

/* Digits beyond what files have are noise of the arithmetic here. */
static double rounded(double number, double size)
{
    double unit = 1e-5 * size;
    return round(number / unit) * unit;
}

static void add_point(Text *scene, const double v[3], double size)
{
    for (int i = 0; i < 3; i++)
        text_format(scene, "%s%.7g", i == 0 ? "[" : ", ", rounded(v[i], size) + 0.0);
    text_add(scene, "]");
}

static bool read_color(const JsurfSurface *surface, const char *key, const double otherwise[3],
                       char hex[8])
{
    double color[3] = {otherwise[0], otherwise[1], otherwise[2]};
    if (!jsurf_numbers(surface, key, color, 3))
        return false;
    hex[0] = '#';
    for (int i = 0; i < 3; i++) {
        int level      = (int)lround(255 * fmin(fmax(color[i], 0), 1));
        hex[2 * i + 1] = "0123456789abcdef"[level / 16];
        hex[2 * i + 2] = "0123456789abcdef"[level % 16];
    }
    hex[7] = '\0';
    return true;
}

/* The ball's distance from the eye does not count for an orthographic camera, but the eye must be
   outside. */
static bool write_camera(const JsurfSurface *surface, const Space *camera)
{
    static const double  origin[3] = {0, 0, 0}, back[3] = {0, 0, 1}, upwards[3] = {0, 1, 0};
    const JsurfProperty *type = jsurf_property(surface, "camera_type");
    bool                 flat = !type || strcmp(type->value, "ORTHOGRAPHIC_CAMERA") == 0;
    double               eye[3], backward[3], up[3], height = 2, fov = 60, target[3];
    if (!flat && strcmp(type->value, "PERSPECTIVE_CAMERA") != 0)
        return import_refuse(surface->import, type->line, "no camera is a `%.60s`", type->value);
    if (!jsurf_numbers(surface, "camera_height", &height, 1) ||
        !jsurf_numbers(surface, "camera_fov_y", &fov, 1))
        return false;
    if (flat ? !(height > 0) : !(fov > 0 && fov < 180))
        return refuse_space(surface, flat ? "camera_height" : "camera_fov_y", "shows nothing");
    space_apply(camera, origin, 1, eye);
    space_apply(camera, back, 0, backward);
    space_apply(camera, upwards, 0, up);
    double ahead = dot3(eye, backward), distance = flat ? fmax(ahead, 4) : fmax(ahead, 0.1);
    for (int i = 0; i < 3; i++) {
        target[i] = surface->scale * (eye[i] - ahead * backward[i]);
        eye[i]    = target[i] + surface->scale * backward[i] * (flat ? distance : ahead);
        target[i] = eye[i] - surface->scale * backward[i] * distance;
    }
    Text *scene = &surface->import->scene;
    import_mark(surface->import, type ? type->line : 1);
    text_add(scene, "camera {\n    eye: ");
    add_point(scene, eye, surface->scale);
    text_add(scene, ",\n    target: ");
    add_point(scene, target, surface->scale);
    text_add(scene, ",\n    up: ");
    add_point(scene, up, 1);
    if (flat)
        text_format(scene, ",\n    projection: \"orthographic\",\n    height: %.7g\n}\n",
                    height * surface->scale);
    else
        text_format(scene, ",\n    fov: %.7gdeg\n}\n", fov);
    return true;
}

/* Writes a light: those of SURFER grow no weaker with distance, so they get as much stronger as
   they are far. */
static bool write_light(const JsurfSurface *surface, const Space *camera, int number)
{
    static const double white[3] = {1, 1, 1};
    char                key[64], color[8];
    double              position[3] = {0, 0, 0}, intensity = 1, eye[3];
    snprintf(key, sizeof key, "light_status_%d", number);
    const JsurfProperty *status = jsurf_property(surface, key);
    if (!status || strcmp(status->value, "ON") != 0)
        return true;
    snprintf(key, sizeof key, "light_position_%d", number);
    if (!jsurf_numbers(surface, key, position, 3))
        return false;
    snprintf(key, sizeof key, "light_intensity_%d", number);
    if (!jsurf_numbers(surface, key, &intensity, 1))
        return false;
    snprintf(key, sizeof key, "light_color_%d", number);
    if (!read_color(surface, key, white, color))
        return false;
    space_apply(camera, position, 1, eye);
    double size = surface->scale, distance = size * fmax(sqrt(dot3(eye, eye)), 1);
    for (int i = 0; i < 3; i++)
        eye[i] *= size;
    Text *scene = &surface->import->scene;
    import_mark(surface->import, status->line);
    text_add(scene, "light { position: ");
    add_point(scene, eye, distance);
    text_format(scene, ", color: %s, intensity: %.4g }\n", color,
                2 * fmax(intensity, 0) * distance * distance);
    return true;
}

static bool write_view(const JsurfSurface *surface, const Space *camera)
{
    static const double grey[3] = {0.5, 0.5, 0.5}, white[3] = {1, 1, 1};
    char                front[8], back[8], sky[8];
    double              shininess = 30;
    if (!read_color(surface, "front_material_color", grey, front) ||
        !read_color(surface, "back_material_color", grey, back) ||
        !read_color(surface, "background_color", white, sky) ||
        !jsurf_numbers(surface, "front_material_shininess", &shininess, 1))
        return false;
    Text *scene = &surface->import->scene;
    text_add(scene, "material sides {\n    color: ");
    if (strcmp(front, back) == 0)
        text_add(scene, front);
    else
        text_format(scene, "if front then %s else %s", front, back);
    text_format(scene, ",\n    roughness: %.2f\n}\n", sqrt(2 / (fmax(shininess, 0) + 2)));
    import_mark(surface->import, jsurf_line(surface, "surface_equation"));
    text_format(scene, "show %s.within(sphere(%.7g), open: true).paint(sides);\n\n",
                surface->import->as_field ? "field(equation)" : "algebraic(equation == 0)",
                surface->scale);
    if (!write_camera(surface, camera))
        return false;
    for (int i = 0; i < LIGHTS; i++)
        if (!write_light(surface, camera, i))
            return false;
    text_format(scene, "sky { zenith: %s, horizon: %s, ground: %s }\n", sky, sky, sky);
    return true;
}

bool import_jsurf(Import *import)
{
    JsurfSurface surface = {.import = import};
    Space        camera;
    Text         equation = {.arena = import->arena};
    if (!jsurf_read(&surface) || !jsurf_equation(&surface, &equation) ||
        !read_spaces(&surface, &camera))
        return false;
    text_format(&import->scene, "// From %s.\n\n", import->name);
    if (!jsurf_write_parameters(&surface))
        return false;
    text_format(&import->scene, "// %sWithout `open: true` it is a solid, below 0.\n",
                import->as_field ? "No polynomial.  " : "");
    import_mark(import, jsurf_line(&surface, "surface_equation"));
    text_format(&import->scene, "let equation =\n    %s;\n", equation.bytes);
    return write_view(&surface, &camera);
}
