/*
 * view.c: what is known of camera, lights and sky, as constants.
 */
#include "export/parts.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"

double find_farthest(const Export *export)
{
    const KrsCamera *camera = &export->view.camera;
    double           far[3], low[3], high[3];
    find_extent(export, low, high);
    for (int k = 0; k < 3; k++)
        far[k] = fmax(fabs(low[k] - camera->eye[k]), fabs(high[k] - camera->eye[k]));
    const double corner = length3(far);
    const double enough = 1e4 * distance3(camera->eye, camera->target);
    return corner < enough ? corner : enough;
}

void find_extent(const Export *export, double low[3], double high[3])
{
    if (export->baked)
        find_baked_box(export, low, high);
    else {
        memcpy(low, export->scene->program.low, sizeof export->scene->program.low);
        memcpy(high, export->scene->program.high, sizeof export->scene->program.high);
    }
}

void find_box(const Export *export, double low[3], double high[3])
{
    const KrsCamera *camera = &export->view.camera;
    const double    *eye = camera->eye, way = distance3(eye, camera->target);
    const double     far = fmin(find_farthest(export),
                                100 * way); /* rays begin there, in single precision */
    find_extent(export, low, high);
    for (int k = 0; k < 3; k++) {
        low[k]  = fmax(low[k], eye[k] - far);
        high[k] = fmin(high[k], eye[k] + far);
    }
}

void find_upright(const KrsCamera *camera, double up[3])
{
    double ahead[3], across[3];
    memcpy(up, camera->up, sizeof camera->up);
    for (int k = 0; k < 3; k++)
        ahead[k] = camera->target[k] - camera->eye[k];
    cross3(ahead, up, across);
    if (length3(across) / (length3(ahead) * length3(up)) > 1e-6)
        return;
    up[0] = 0;
    up[1] = fabs(ahead[2]) > fabs(ahead[1]);
    up[2] = fabs(ahead[2]) <= fabs(ahead[1]) ? -1 : 0;
}

double find_rise(const KrsCamera *camera)
{
    return camera->projection == KRS_PERSPECTIVE
               ? tan(0.5 * camera->fov)
               : 0.5 * camera->height / distance3(camera->eye, camera->target);
}

/* Four numbers of a light. */
typedef void LightNumbers(const KrsLight *light, double numbers[4]);

static void place_of(const KrsLight *light, double numbers[4])
{
    memcpy(numbers, light->vector, sizeof light->vector);
    numbers[3] = light->positional;
}

/* Finds the light's colour, and the radius of the disc that stands for it: of a direction, at
   distance 1. */
static void color_of(const KrsLight *light, double numbers[4])
{
    memcpy(numbers, light->color, sizeof light->color);
    numbers[3] = fmax(light->positional ? light->softness : 0.5 * light->softness, 1e-3);
}

/* Finds where a light shines, and the cosine at the edge of its cone; -2: everywhere. */
static void cone_of(const KrsLight *light, double numbers[4])
{
    memcpy(numbers, light->axis, sizeof light->axis);
    numbers[3] = light->spot ? cos(0.5 * light->angle) : -2;
}

static void add_lights(Text *to, const Export *export, const char *name, LightNumbers *find)
{
    static const KrsLight nowhere = {0};
    const size_t          count   = export->view.light_count ? export->view.light_count : 1;
    text_format(to, "const vec4  %s[%zu] = vec4[%zu](", name, count, count);
    for (size_t i = 0; i < count; i++) {
        double numbers[4];
        find(export->view.light_count ? &export->view.lights[i] : &nowhere, numbers);
        text_add(to, i ? ", " : "");
        add_vector(to, export, numbers, 4);
    }
    text_add(to, ");\n");
}

static void add_edges(Text *to, const Export *export)
{
    const size_t count = export->view.light_count ? export->view.light_count : 1;
    text_format(to, "const float krs_light_edge[%zu] = float[%zu](", count, count);
    for (size_t i = 0; i < count; i++) {
        const KrsLight *light = export->view.light_count ? &export->view.lights[i] : NULL;
        const double    edge  = light && light->spot ? 0.5 * light->angle * (1 - light->edge) : 0;
        text_add(to, i ? ", " : "");
        add_float(to, cos(edge));
    }
    text_add(to, ");\n");
}

static void add_number_constant(Text *to, const char *name, double number)
{
    text_format(to, "const float %s = ", name);
    add_float(to, number);
    text_add(to, ";\n");
}

static void add_vector_constant(Text *to, const Export *export, const char *name,
                                const double numbers[3])
{
    text_format(to, "const vec3  %s = ", name);
    add_vector(to, export, numbers, 3);
    text_add(to, ";\n");
}

void add_farthest(Text *to, const Export *export)
{
    add_number_constant(to, "KRS_FARTHEST", find_farthest(export));
}

void add_constants(Text *to, const Export *export)
{
    const KrsView *view = &export->view;
    double         up[3];
    find_upright(&view->camera, up);
    add_vector_constant(to, export, "KRS_EYE", view->camera.eye);
    add_vector_constant(to, export, "KRS_TARGET", view->camera.target);
    add_vector_constant(to, export, "KRS_UP", up);
    add_number_constant(to, "KRS_RISE", find_rise(&view->camera));
    add_farthest(to, export);
    add_number_constant(to, "KRS_OPEN_REACH",
                        0.1 * distance3(view->camera.eye, view->camera.target));
    add_vector_constant(to, export, "KRS_ZENITH", view->sky.zenith);
    add_vector_constant(to, export, "KRS_HORIZON", view->sky.horizon);
    add_vector_constant(to, export, "KRS_GROUND", view->sky.ground);
    text_format(to,
                "const int   KRS_MAX_STEPS = 1024, KRS_MAX_SHADOW_STEPS = 64, KRS_LIGHTS = %zu;\n",
                view->light_count);
    text_add(to, "// Each light: position or direction, and 1: it has a position; colour and "
                 "radius; its cone.\n");
    add_lights(to, export, "krs_light_at", place_of);
    add_lights(to, export, "krs_light_color", color_of);
    add_lights(to, export, "krs_light_cone", cone_of);
    add_edges(to, export);
}

void add_camera(Text *to, const Export *export)
{
    const KrsCamera *camera = &export->view.camera;
    text_add(to, "{ eye: ");
    text_json_vector(to, camera->eye, 3);
    text_add(to, ", target: ");
    text_json_vector(to, camera->target, 3);
    text_add(to, ", up: ");
    text_json_vector(to, camera->up, 3);
    text_add(to, ", fov: ");
    text_json_number(to, 2 * atan(find_rise(camera)));
    text_add(to, " }");
}
