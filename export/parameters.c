/*
 * parameters.c: parameters with their ranges, and the slots that functions read.
 */
#include "export/parts.h"

#include <math.h>
#include <string.h>

KrsParameter parameter_of(const Export *export, size_t index)
{
    KrsParameter parameter;
    krs_parameter(export->scene, index, &parameter);
    return parameter;
}

/* No language has two underscores side by side, nor names that are too long: what is other has its slot in it. */
void add_parameter_name(Text *to, const char *prefix, const char *name, size_t slot)
{
    enum { LONGEST = 100 };
    const size_t length = strlen(name);
    text_add(to, prefix);
    if (name[0] != '_' && !strstr(name, "__") && length <= LONGEST) {
        text_add(to, name);
        return;
    }
    text_format(to, "%zu", slot);
    for (size_t i = 0; i < length && i < LONGEST; i++)
        if (name[i] != '_' || name[i + 1] != '_')
            text_add_bytes(to, name + i, 1);
}

bool has_slider(const KrsParameter *parameter)
{
    return parameter->components == 1 && isfinite(parameter->low[0]) &&
           isfinite(parameter->high[0]);
}

bool is_color(const KrsParameter *parameter)
{
    return parameter->color && parameter->components >= 3;
}

static bool has_range(const KrsParameter *parameter)
{
    return isfinite(parameter->low[0]) || isfinite(parameter->high[0]);
}

static void add_parameter_range(Text *to, const KrsParameter *parameter)
{
    text_number(to, parameter->low[0]);
    text_add(to, " to ");
    text_number(to, parameter->high[0]);
}

/* Finds what a slot of the block has. */
static void value_of(const Export *export, size_t slot, double value[4])
{
    for (int k = 0; k < 4; k++)
        value[k] = (double)export->block[slot][k];
}

/* Adds lines, each a constant with its range behind it. */
void add_constant_parameters(Text *to, const Export *export)
{
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        double             value[4];
        value_of(export, 1 + i, value);
        if (parameter.components == 1) {
            text_add(to, "const float ");
            add_parameter_name(to, "PARAM_", parameter.name, 1 + i);
            text_add(to, " = ");
            add_float(to, value[0]);
        } else {
            text_format(to, "const vec%u  ", parameter.components);
            add_parameter_name(to, "PARAM_", parameter.name, 1 + i);
            text_add(to, " = ");
            add_vector(to, export, value, (int)parameter.components);
        }
        text_add(to, ";");
        if (has_range(&parameter)) {
            text_add(to, " // ");
            add_parameter_range(to, &parameter);
        }
        text_add(to, "\n");
    }
}

/* Adds statements that put them into their slots; those behind have what the scene was exported with. */
void set_constant_parameters(Text *to, const Export *export)
{
    static const char *const padding[] = {"", ", 0.0, 0.0, 0.0", ", 0.0, 0.0", ", 0.0", ""};
    const size_t             count     = exported_parameters(export);
    for (size_t i = 0; i < count; i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_format(to, "    krs_parameter[%zu] = vec4(", 1 + i);
        add_parameter_name(to, "PARAM_", parameter.name, 1 + i);
        text_format(to, "%s);\n", padding[parameter.components]);
    }
    for (size_t i = 1 + count; i < exported_slots(export); i++) {
        double value[4];
        value_of(export, i, value);
        text_format(to, "    krs_parameter[%zu] = ", i);
        add_vector(to, export, value, 4);
        text_add(to, ";\n");
    }
}

void add_parameters_json(Text *to, const Export *export)
{
    text_add(to, "[");
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_add(to, i ? ",\n    { name: " : "\n    { name: ");
        text_json(to, parameter.name);
        text_format(to, ", slot: %zu, value: ", 1 + i);
        text_json_vector(to, parameter.value, parameter.components);
        text_add(to, ", low: ");
        text_json_vector(to, parameter.low, parameter.components);
        text_add(to, ", high: ");
        text_json_vector(to, parameter.high, parameter.components);
        text_add(to, " }");
    }
    text_add(to, "]");
}

void add_block(Text *to, const Export *export)
{
    text_add(to, "[");
    for (size_t i = 0; i < 4 * exported_slots(export); i++) {
        text_add(to, i ? ", " : "");
        text_json_number(to, (double)export->block[i / 4][i % 4]);
    }
    text_add(to, "]");
}

/* Adds comments that say where each of them is. */
void add_parameter_lines(Text *to, const Export *export)
{
    static const char *const parts[] = {"", ".x", ".xy", ".xyz", ""};
    text_add(to, "//   krs_parameter[0].x: the time\n");
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_format(to, "//   krs_parameter[%zu]%s: %s", 1 + i, parts[parameter.components],
                    parameter.name);
        if (has_range(&parameter)) {
            text_add(to, ", ");
            add_parameter_range(to, &parameter);
        }
        text_add(to, parameter.degrees ? ", in radians\n"
                     : parameter.color ? ", of linear light\n"
                                       : "\n");
    }
}

/* Adds all slots, with commas between. */
void add_defaults(Text *to, const Export *export)
{
    for (size_t i = 0; i < exported_slots(export); i++) {
        double value[4];
        value_of(export, i, value);
        text_add(to, i ? ", " : "");
        add_vector(to, export, value, 4);
    }
}
