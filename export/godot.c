/*
 * godot.c: what a shader and a scene of Godot say of parameters, camera and lights.
 */
#include <math.h>
#include <string.h>

#include "compiler/base/srgb.h"
#include "compiler/base/vec.h"
#include "export/parts.h"

/* ---- parameters ---- */

static void add_uniform(Text *to, const Export *export, size_t i)
{
    const KrsParameter parameter = parameter_of(export, i);
    const bool         color     = is_color(&parameter);
    double             value[4];
    for (int k = 0; k < 4; k++) {
        value[k] = (double)export->block[1 + i][k];
        value[k] = color && k < 3 ? srgb_of_linear(value[k]) : value[k];
    }
    text_add(to, "uniform ");
    if (parameter.components == 1)
        text_add(to, "float ");
    else
        text_format(to, "vec%u ", parameter.components);
    add_parameter_name(to, "param_", parameter.name, 1 + i);
    if (has_slider(&parameter)) {
        text_add(to, " : hint_range(");
        add_float(to, parameter.low[0]);
        text_add(to, ", ");
        add_float(to, parameter.high[0]);
        text_add(to, parameter.whole ? ", 1.0)" : ")");
    }
    text_add(to, color ? " : source_color = " : " = ");
    if (parameter.components == 1)
        add_float(to, value[0]);
    else
        add_vector(to, export, value, (int)parameter.components);
    text_add(to, ";\n");
}

void add_godot_uniforms(Text *to, const Export *export)
{
    for (size_t i = 0; i < exported_parameters(export); i++)
        add_uniform(to, export, i);
}

void set_godot_parameters(Text *to, const Export *export)
{
    text_add(to, "    krs.parameter[0] = vec4(TIME, 0.0, 0.0, 0.0);\n");
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_format(to, "    krs.parameter[%zu] = vec4(", 1 + i);
        add_parameter_name(to, "param_", parameter.name, 1 + i);
        for (uint32_t k = parameter.components; k < 4; k++)
            text_add(to, ", 0.0");
        text_add(to, ");\n");
    }
}

/* ---- the scene ---- */

static void add_numbers(Text *to, const double v[3])
{
    for (int k = 0; k < 3; k++) {
        text_add(to, k ? ", " : "");
        text_number(to, v[k]);
    }
}

/* Finds the middle of the box, and half of its sides. */
static void find_middle(const Export *export, double middle[3], double half[3])
{
    double low[3], high[3];
    find_box(export, low, high);
    for (int k = 0; k < 3; k++) {
        middle[k] = 0.5 * (low[k] + high[k]);
        half[k]   = 0.5 * (high[k] - low[k]);
    }
}

void add_center(Text *to, const Export *export)
{
    double middle[3], half[3];
    find_middle(export, middle, half);
    add_vector(to, export, middle, 3);
}

void add_half(Text *to, const Export *export)
{
    double middle[3], half[3];
    find_middle(export, middle, half);
    add_vector(to, export, half, 3);
}

void add_center_numbers(Text *to, const Export *export)
{
    double middle[3], half[3];
    find_middle(export, middle, half);
    add_numbers(to, middle);
}

void add_size_numbers(Text *to, const Export *export)
{
    double middle[3], half[3];
    find_middle(export, middle, half);
    for (int k = 0; k < 3; k++)
        half[k] *= 2;
    add_numbers(to, half);
}

/* Adds the transform of what stands at a place and looks against an axis: rows of three, and the place. */
static void add_transform(Text *to, const double back[3], const double up[3], const double at[3])
{
    double axes[3][3];
    memcpy(axes[2], back, sizeof axes[2]);
    normalize3(axes[2]);
    cross3(up, axes[2], axes[0]);
    normalize3(axes[0]);
    cross3(axes[2], axes[0], axes[1]);
    text_add(to, "transform = Transform3D(");
    for (int i = 0; i < 9; i++) {
        text_number(to, axes[i % 3][i / 3]);
        text_add(to, ", ");
    }
    add_numbers(to, at);
    text_add(to, ")\n");
}

static void add_camera_node(Text *to, const Export *export)
{
    const KrsCamera *camera = &export->view.camera;
    double           back[3], up[3];
    for (int k = 0; k < 3; k++)
        back[k] = camera->eye[k] - camera->target[k];
    find_upright(camera, up);
    text_add(to, "\n[node name=\"Camera3D\" type=\"Camera3D\" parent=\".\"]\n");
    add_transform(to, back, up, camera->eye);
    if (camera->projection == KRS_PERSPECTIVE)
        text_format(to, "fov = %.6g\n", 2 * atan(find_rise(camera)) * 57.29577951308232);
    else
        text_format(to, "projection = 1\nsize = %.6g\n", camera->height);
    text_format(to, "far = %.6g\n", fmax(2 * find_farthest(export), 1));
}

static void add_color(Text *to, const char *name, const double light[3], double most)
{
    text_format(to, "%s = Color(", name);
    for (int k = 0; k < 3; k++)
        text_format(to, "%.6g, ", most > 0 ? srgb_of_linear(light[k] / most) : 0);
    text_add(to, "1)\n");
}

void add_godot_sky(Text *to, const Export *export)
{
    const KrsSky *sky = &export->view.sky;
    add_color(to, "sky_top_color", sky->zenith, 1);
    add_color(to, "sky_horizon_color", sky->horizon, 1);
    add_color(to, "ground_horizon_color", sky->horizon, 1);
    add_color(to, "ground_bottom_color", sky->ground, 1);
    text_add(to, "sun_angle_max = 0.0\n"); /* the lights of the scene are no discs in it */
}

/* Adds a light, whose energy is that of a white surface in Godot, and whose cone is told by half its angle. */
static void add_light_node(Text *to, const KrsLight *light, size_t number)
{
    static const double nowhere[3] = {0};
    const double        degree     = 57.29577951308232;
    const double        most       = fmax(fmax(light->color[0], light->color[1]), light->color[2]);
    const char         *type = !light->positional ? "Directional" : light->spot ? "Spot" : "Omni";
    const double        back[3]  = {-light->axis[0], -light->axis[1], -light->axis[2]};
    const double        ahead[3] = {0, 0, 1};
    const double       *behind   = !light->positional ? light->vector : light->spot ? back : ahead;
    const double        up[3]    = {0, fabs(behind[1]) < 0.999, fabs(behind[1]) >= 0.999};
    text_format(to, "\n[node name=\"Light%zu\" type=\"%sLight3D\" parent=\".\"]\n", number, type);
    add_transform(to, behind, up, light->positional ? light->vector : nowhere);
    add_color(to, "light_color", light->color, most);
    text_format(to, "light_energy = %.6g\nshadow_enabled = true\n", most / 3.141592653589793);
    if (!light->positional)
        text_format(to, "light_angular_distance = %.6g\n", degree * light->softness);
    else
        text_format(to, "light_size = %.6g\n", light->softness);
    if (light->spot)
        text_format(to, "spot_range = 1000.0\nspot_attenuation = 2.0\nspot_angle = %.6g\n",
                    fmin(0.5 * degree * light->angle, 89.9));
    else if (light->positional)
        text_add(to, "omni_range = 1000.0\nomni_attenuation = 2.0\n");
}

void add_godot_nodes(Text *to, const Export *export)
{
    add_camera_node(to, export);
    for (size_t i = 0; i < export->view.light_count; i++)
        add_light_node(to, &export->view.lights[i], 1 + i);
}
