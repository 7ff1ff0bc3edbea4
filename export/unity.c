/*
 * unity.c: what a shader and a script of Unity say of parameters and of the box, and a node of Unreal.
 */
#include <math.h>

#include "compiler/base/srgb.h"
#include "export/parts.h"

/* Adds a number, for C# with an f behind. */
static void add_number(Text *to, double number, bool script)
{
    add_float(to, number);
    text_add(to, script ? "f" : "");
}

/* Adds four numbers with commas between: those of a slot, and of a colour those of a colour picker. */
static void add_value(Text *to, const Export *export, size_t slot, bool color, bool script)
{
    for (int k = 0; k < 4; k++) {
        const double number = (double)export->block[slot][k];
        text_add(to, k ? ", " : "");
        add_number(to, !color ? number : k == 3 ? 1 : srgb_of_linear(number), script);
    }
}

void add_unity_properties(Text *to, const Export *export)
{
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        const bool         color     = is_color(&parameter);
        text_add(to, "        ");
        add_parameter_name(to, "_", parameter.name, 1 + i);
        text_format(to, "(\"%s\", ", parameter.name);
        if (has_slider(&parameter)) {
            text_add(to, "Range(");
            add_float(to, parameter.low[0]);
            text_add(to, ", ");
            add_float(to, parameter.high[0]);
            text_add(to, ")");
        } else
            text_add(to, color ? "Color" : parameter.components == 1 ? "Float" : "Vector");
        text_add(to, parameter.components == 1 ? ") = " : ") = (");
        if (parameter.components == 1)
            add_float(to, (double)export->block[1 + i][0]);
        else
            add_value(to, export, 1 + i, color, false);
        text_add(to, parameter.components == 1 ? "\n" : ")\n");
    }
}

void add_unity_uniforms(Text *to, const Export *export)
{
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_add(to, parameter.components == 1 ? "            float " : "            float4 ");
        add_parameter_name(to, "_", parameter.name, 1 + i);
        text_add(to, ";\n");
    }
}

/* Adds statements that fill slots: from names with a prefix, of which vectors have so many components. */
static void set_parameters(Text *to, const Export *export, const char *start, const char *prefix)
{
    static const char *const parts[]   = {"", "", ".xy", ".xyz", ""};
    static const char *const padding[] = {"", ", 0.0, 0.0, 0.0", ", 0.0, 0.0", ", 0.0", ""};
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_format(to, "%skrs_parameter[%zu] = float4(", start, 1 + i);
        add_parameter_name(to, prefix, parameter.name, 1 + i);
        text_format(to, "%s%s);\n", parts[parameter.components], padding[parameter.components]);
    }
}

void add_unity_parameters(Text *to, const Export *export)
{
    set_parameters(to, export, "            ", "_");
}

void add_unity_fields(Text *to, const Export *export)
{
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        const bool         color     = is_color(&parameter);
        text_add(to, "    ");
        if (has_slider(&parameter)) {
            text_add(to, "[Range(");
            add_number(to, parameter.low[0], true);
            text_add(to, ", ");
            add_number(to, parameter.high[0], true);
            text_add(to, ")] ");
        }
        text_format(to, "public %s ",
                    parameter.components == 1 ? "float"
                    : color                   ? "Color"
                                              : "Vector4");
        add_parameter_name(to, "param_", parameter.name, 1 + i);
        if (parameter.components == 1) {
            text_add(to, " = ");
            add_number(to, (double)export->block[1 + i][0], true);
        } else {
            text_format(to, " = new %s(", color ? "Color" : "Vector4");
            add_value(to, export, 1 + i, color, true);
            text_add(to, ")");
        }
        text_add(to, ";\n");
    }
}

void add_unity_sets(Text *to, const Export *export)
{
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_format(to, "        block.Set%s(\"",
                    parameter.components == 1 ? "Float"
                    : is_color(&parameter)    ? "Color"
                                              : "Vector");
        add_parameter_name(to, "_", parameter.name, 1 + i);
        text_add(to, "\", ");
        add_parameter_name(to, "param_", parameter.name, 1 + i);
        text_add(to, ");\n");
    }
}

/* Adds a name of C#: the stem of files, in which all but letters, digits and "_" is "_". */
void add_unity_class(Text *to, const Export *export)
{
    text_add(to, "Krs_");
    for (const char *from = export->stem; *from; from++) {
        const char c     = *from;
        const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
                           (c >= '0' && c <= '9');
        text_add_bytes(to, plain ? from : "_", 1);
    }
}

static void add_box_number(Text *to, const Export *export, bool middle)
{
    double low[3], high[3];
    find_box(export, low, high);
    for (int k = 0; k < 3; k++) {
        const double number = 0.5 * (middle ? low[k] + high[k] : high[k] - low[k]);
        text_add(to, k ? ", " : "");
        add_number(to, middle && k == 2 ? -number : number,
                   true); /* Unity's z goes the other way */
    }
}

void add_unity_center(Text *to, const Export *export) { add_box_number(to, export, true); }
void add_unity_half(Text *to, const Export *export) { add_box_number(to, export, false); }

/* ---- Unreal ---- */

void add_unreal_inputs(Text *to, const Export *export)
{
    for (size_t i = 0; i < exported_parameters(export); i++) {
        const KrsParameter parameter = parameter_of(export, i);
        text_add(to, "//   ");
        add_parameter_name(to, "param_", parameter.name, 1 + i);
        text_format(to, ": %s, ", parameter.components == 1 ? "a number" : "a vector");
        if (has_slider(&parameter)) {
            text_number(to, parameter.low[0]);
            text_add(to, " to ");
            text_number(to, parameter.high[0]);
            text_add(to, ", ");
        }
        text_add(to, "here ");
        for (uint32_t k = 0; k < parameter.components; k++) {
            text_add(to, k ? ", " : "");
            add_float(to, (double)export->block[1 + i][k]);
        }
        text_add(to, is_color(&parameter) ? " of linear light\n" : "\n");
    }
}

void add_unreal_parameters(Text *to, const Export *export)
{
    set_parameters(to, export, "krs.", "param_");
}
