// glb_materials.cpp: materials of glTF, with extensions: by the rows of gltf_fields.def.
#include "cli/glb_materials.h"

#include <algorithm>
#include <cmath>

namespace
{

double largest(const double numbers[3]) { return std::max({numbers[0], numbers[1], numbers[2]}); }

std::vector<double> scaled(const double numbers[3], double factor)
{
    return {factor * numbers[0], factor * numbers[1], factor * numbers[2]};
}

std::vector<double> base_color_of(const MeshMaterial &m)
{
    const double *color = m.look.color;
    return m.even ? std::vector<double>{color[0], color[1], color[2], 1}
                  : std::vector<double>{1, 1, 1, 1};
}

// A factor of the emission, which is a color up to 1.
double emission_of(const MeshMaterial &m) { return std::fmax(largest(m.look.emission), 1); }

// What is left of a color where 1/e is of the one that is absorbed most.
double left_of(const double absorption[3], int color)
{
    double most = largest(absorption);
    return most > 0 ? std::exp(-absorption[color] / most) : 1;
}

// The widths of the lobe along the tangent and across it, as of OpenPBR (runtime/shaders/anisotropy.glsl).
double width_along(const MeshMaterial &m)
{
    double across = 1 - m.look.specular_roughness_anisotropy;
    return m.look.roughness * m.look.roughness * std::sqrt(2 / (1 + across * across));
}

double width_across(const MeshMaterial &m)
{
    return (1 - m.look.specular_roughness_anisotropy) * width_along(m);
}

double roughness_across(const MeshMaterial &m)
{
    return m.look.specular_roughness_anisotropy > 0 ? std::sqrt(width_across(m)) : m.look.roughness;
}

double anisotropy_of(const MeshMaterial &m)
{
    double across = width_across(m), wider = width_along(m) - across;
    return m.look.specular_roughness_anisotropy > 0 && wider > 0
               ? std::sqrt(std::fmin(wider / (1 - across), 1))
               : 0;
}

struct Field {
    const char *extension, *name;
    double      usual;
    std::vector<double> (*values)(const MeshMaterial &m, double length);
};

const Field fields[] = {
#define GLTF_FIELD(extension, field, usual, ...)                         \
    {extension, field, usual, [](const MeshMaterial &m, double length) { \
         (void)m;                                                        \
         (void)length;                                                   \
         return std::vector<double>{__VA_ARGS__};                        \
     }},
#include "cli/gltf_fields.def"
};

bool is_usual(const Field &field, const std::vector<double> &values)
{
    return std::all_of(values.begin(), values.end(),
                       [&](double value) { return value == field.usual; });
}

tinygltf::Value value_of(const std::vector<double> &numbers)
{
    if (numbers.size() == 1)
        return tinygltf::Value(numbers[0]);
    tinygltf::Value::Array values;
    for (double number : numbers)
        values.push_back(tinygltf::Value(number));
    return tinygltf::Value(values);
}

// What is not finite, as the distance in which light without absorption grows weaker, is the usual one.
void add_extensions(tinygltf::Model &model, tinygltf::Material &material, const MeshMaterial &m,
                    double length)
{
    std::string             current;
    tinygltf::Value::Object content;
    bool                    wanted = false;
    for (const Field &field : fields) {
        std::vector<double> values = field.values(m, length);
        if (current != field.extension) {
            content.clear();
            current = field.extension;
            wanted  = !is_usual(field, values);
        }
        if (!wanted)
            continue;
        if (std::isfinite(values[0]))
            content[field.name] = value_of(values);
        material.extensions[current] = tinygltf::Value(content);
        glb_use_extension(model.extensionsUsed, field.extension);
    }
}

} // namespace

void glb_use_extension(std::vector<std::string> &extensions, const char *name)
{
    if (std::find(extensions.begin(), extensions.end(), name) == extensions.end())
        extensions.push_back(name);
}

void glb_add_materials(tinygltf::Model &model, const MeshParts *parts)
{
    for (size_t i = 0; i < parts->material_count; i++) {
        const MeshMaterial &m = parts->materials[i];
        tinygltf::Material  material;
        material.name = m.name;
#define GLTF_CORE(member, ...) material.member = __VA_ARGS__;
#include "cli/gltf_fields.def"
        add_extensions(model, material, m, parts->scale * parts->metres);
        model.materials.push_back(material);
    }
}
