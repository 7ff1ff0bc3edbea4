/*
 * blender.c: what a shader in OSL says of parameters, and a script for Blender of camera, lights and sky.
 */
#include <math.h>

#include "export/parts.h"

/* Adds for each slot the words for the time, or for a parameter, with commas between: `slot` says what. */
static void add_slots(Text *to, const Export *export,
                      void (*slot)(Text *to, const Export *export, size_t slot))
{
    const size_t slots = 1 + exported_parameters(export);
    for (size_t i = 0; i < slots; i++) {
        text_add(to, i ? ", " : "");
        slot(to, export, i);
    }
}

static void add_given_slot(Text *to, const Export *export, size_t slot)
{
    (void)export;
    text_format(to, "vec4 given%zu", slot);
}
static void add_passed_slot(Text *to, const Export *export, size_t slot)
{
    (void)export;
    text_format(to, "given%zu", slot);
}

/* A colour or a vector is three numbers; the fourth is a parameter of its own. */
static void add_value_slot(Text *to, const Export *export, size_t slot)
{
    if (slot == 0) {
        text_add(to, "KrsVec4(Seconds, 0.0, 0.0, 0.0)");
        return;
    }
    const KrsParameter parameter = parameter_of(export, slot - 1);
    text_add(to, "KrsVec4(");
    for (uint32_t k = 0; k < 4; k++) {
        text_add(to, k ? ", " : "");
        if (k >= parameter.components) {
            text_add(to, "0.0");
            continue;
        }
        add_parameter_name(to, "param_", parameter.name, slot);
        if (k == 3)
            text_add(to, "_w");
        else if (parameter.components > 1)
            text_format(to, "[%u]", k);
    }
    text_add(to, ")");
}

void add_osl_given(Text *to, const Export *export) { add_slots(to, export, add_given_slot); }
void add_osl_passed(Text *to, const Export *export) { add_slots(to, export, add_passed_slot); }
void add_osl_values(Text *to, const Export *export) { add_slots(to, export, add_value_slot); }

void set_osl_parameters(Text *to, const Export *export)
{
    for (size_t i = 0; i < 1 + exported_parameters(export); i++)
        text_format(to, "    krs.parameter[%zu] = given%zu;\n", i, i);
}

/* Adds lines of the shader's head, with ranges where an editor may show them. */
void add_osl_parameters(Text *to, const Export *export)
{
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        const float       *value     = export->block[1 + i];
        text_format(to, "    %s ",
                    parameter.components == 1 ? "float"
                    : parameter.color         ? "color"
                                              : "vector");
        add_parameter_name(to, "param_", parameter.name, 1 + i);
        text_format(to, " = %s",
                    parameter.components == 1 ? ""
                    : parameter.color         ? "color("
                                              : "vector(");
        for (uint32_t k = 0; k < (parameter.components == 1 ? 1 : 3); k++) {
            text_add(to, k ? ", " : "");
            add_float(to, (double)value[k]);
        }
        text_add(to, parameter.components == 1 ? "" : ")");
        if (parameter.components == 1 && isfinite(parameter.low[0]) &&
            isfinite(parameter.high[0])) {
            text_add(to, " [[ float min = ");
            add_float(to, parameter.low[0]);
            text_add(to, ", float max = ");
            add_float(to, parameter.high[0]);
            text_add(to, " ]]");
        }
        text_add(to, ",\n");
        if (parameter.components == 4) {
            text_add(to, "    float ");
            add_parameter_name(to, "param_", parameter.name, 1 + i);
            text_add(to, "_w = ");
            add_float(to, (double)value[3]);
            text_add(to, ",\n");
        }
    }
}

void add_seconds(Text *to, const Export *export) { add_float(to, (double)export->block[0][0]); }

/* ---- the script ---- */

static void add_list(Text *to, const char *name, const double *numbers, size_t count)
{
    text_format(to, "\"%s\": ", name);
    text_json_vector(to, numbers, count);
}

/* Adds a dictionary: eye, target, up, and half the height of the picture at distance 1; or its height. */
void add_python_camera(Text *to, const Export *export)
{
    const KrsCamera *camera      = &export->view.camera;
    const bool       perspective = camera->projection == KRS_PERSPECTIVE;
    double           up[3];
    find_upright(camera, up);
    text_add(to, "{");
    add_list(to, "eye", camera->eye, 3);
    text_add(to, ", ");
    add_list(to, "target", camera->target, 3);
    text_add(to, ", ");
    add_list(to, "up", up, 3);
    text_format(to, ", \"%s\": ", perspective ? "angle" : "height");
    text_number(to, perspective ? 2 * atan(find_rise(camera)) : camera->height);
    text_add(to, ", \"far\": ");
    text_number(to, fmax(2 * find_farthest(export), 1));
    text_add(to, "}");
}

/* Adds lines, each a dictionary of a light. */
void add_python_lights(Text *to, const Export *export)
{
    for (size_t i = 0; i < export->view.light_count; i++) {
        const KrsLight *light = &export->view.lights[i];
        text_format(to, "    {\"type\": \"%s\", ",
                    !light->positional ? "SUN"
                    : light->spot      ? "SPOT"
                                       : "POINT");
        add_list(to, light->positional ? "place" : "toward", light->vector, 3);
        text_add(to, ", ");
        add_list(to, "color", light->color, 3);
        text_format(to, ", \"size\": %.6g", light->softness);
        if (light->spot) {
            text_add(to, ", ");
            add_list(to, "axis", light->axis, 3);
            text_format(to, ", \"angle\": %.6g, \"edge\": %.6g", light->angle, light->edge);
        }
        text_add(to, "},\n");
    }
}

/* Adds a dictionary of the sky's colours. */
void add_python_sky(Text *to, const Export *export)
{
    const KrsSky *sky = &export->view.sky;
    text_add(to, "{");
    add_list(to, "zenith", sky->zenith, 3);
    text_add(to, ", ");
    add_list(to, "horizon", sky->horizon, 3);
    text_add(to, ", ");
    add_list(to, "ground", sky->ground, 3);
    text_add(to, "}");
}
