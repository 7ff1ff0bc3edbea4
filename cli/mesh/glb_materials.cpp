// glb_materials.cpp: materials of glTF, with extensions: by the rows of gltf_fields.def.
#include "cli/mesh/glb_materials.h"

#include <algorithm>
#include <cmath>

namespace
{

double largest(const double numbers[3]) { return std::max({numbers[0], numbers[1], numbers[2]}); }

std::vector<double> scaled(const double numbers[3], double factor)
{
    return {factor * numbers[0], factor * numbers[1], factor * numbers[2]};
}

// Factors are 1 where a picture shows the color.
std::vector<double> base_color_of(const MeshMaterial &m)
{
    const double *color = m.look.color;
    return m.even ? std::vector<double>{color[0], color[1], color[2], 1}
                  : std::vector<double>{1, 1, 1, 1};
}

// Returns a factor of the emission, which is a color up to 1.
double emission_of(const MeshMaterial &m) { return std::fmax(largest(m.look.emission), 1); }

// Returns the part of a color that is left where 1/e of the most absorbed one is.
double left_of(const double absorption[3], int color)
{
    double most = largest(absorption);
    return most > 0 ? std::exp(-absorption[color] / most) : 1;
}

// Returns the width of the lobe along the tangent, as of OpenPBR (runtime/shaders/anisotropy.glsl).
double width_along(double roughness, double anisotropy)
{
    double across = 1 - anisotropy;
    return roughness * roughness * std::sqrt(2 / (1 + across * across));
}

double width_across(double roughness, double anisotropy)
{
    return (1 - anisotropy) * width_along(roughness, anisotropy);
}

double roughness_of(const MeshMaterial &m)
{
    return m.baked[PICTURE_GLOSS]
               ? 1
               : glb_roughness(m.look.roughness, m.look.specular_roughness_anisotropy);
}

double metallic_of(const MeshMaterial &m) { return m.baked[PICTURE_GLOSS] ? 1 : m.look.metallic; }

double anisotropy_of(const MeshMaterial &m)
{
    const double roughness = m.look.roughness, drawn = m.look.specular_roughness_anisotropy;
    double across = width_across(roughness, drawn), wider = width_along(roughness, drawn) - across;
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
#include "cli/mesh/gltf_fields.def"
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

// Adds the extensions of a material.  A value that is not finite, such as the absorption length of
// clear glass, stays at its default.
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

// Adds a texture for each picture; -1: there is none.
void add_textures(tinygltf::Model &model, const MeshParts *parts, int textures[PICTURES])
{
    static const char *const names[] = {"base colour", "roughness and metallic", "emission"};
    for (int k = 0; k < PICTURES; k++) {
        textures[k] = -1;
        if (!parts->pictures || parts->pictures[k].length == 0)
            continue;
        const MeshPicture          &picture = parts->pictures[k];
        std::vector<unsigned char> &data    = model.buffers[0].data;
        tinygltf::BufferView        view;
        tinygltf::Image             image;
        tinygltf::Texture           texture;
        view.buffer      = 0;
        view.byteOffset  = data.size();
        view.byteLength  = picture.length;
        image.name       = names[k];
        image.mimeType   = "image/png";
        image.bufferView = (int)model.bufferViews.size();
        texture.source   = (int)model.images.size();
        texture.sampler  = 0;
        data.insert(data.end(), picture.bytes, picture.bytes + picture.length);
        data.resize((data.size() + 3) / 4 * 4);
        model.bufferViews.push_back(view);
        model.images.push_back(image);
        textures[k] = (int)model.textures.size();
        model.textures.push_back(texture);
    }
    if (model.textures.empty())
        return;
    tinygltf::Sampler sampler;
    sampler.minFilter = TINYGLTF_TEXTURE_FILTER_LINEAR_MIPMAP_LINEAR;
    sampler.magFilter = TINYGLTF_TEXTURE_FILTER_LINEAR;
    sampler.wrapS = sampler.wrapT = TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE;
    model.samplers.push_back(sampler);
}

void name_textures(const int textures[PICTURES], const MeshMaterial &m,
                   tinygltf::Material &material)
{
    if (m.baked[PICTURE_COLOR])
        material.pbrMetallicRoughness.baseColorTexture.index = textures[PICTURE_COLOR];
    if (m.baked[PICTURE_GLOSS])
        material.pbrMetallicRoughness.metallicRoughnessTexture.index = textures[PICTURE_GLOSS];
    if (m.baked[PICTURE_GLOW])
        material.emissiveTexture.index = textures[PICTURE_GLOW];
}

} // namespace

double glb_roughness(double roughness, double anisotropy)
{
    return anisotropy > 0 ? std::sqrt(width_across(roughness, anisotropy)) : roughness;
}

void glb_use_extension(std::vector<std::string> &extensions, const char *name)
{
    if (std::find(extensions.begin(), extensions.end(), name) == extensions.end())
        extensions.push_back(name);
}

void glb_add_materials(tinygltf::Model &model, const MeshParts *parts)
{
    int textures[PICTURES];
    add_textures(model, parts, textures);
    for (size_t i = 0; i < parts->material_count; i++) {
        const MeshMaterial &m = parts->materials[i];
        tinygltf::Material  material;
        material.name = m.name;
#define GLTF_CORE(member, ...) material.member = __VA_ARGS__;
#include "cli/mesh/gltf_fields.def"
        add_extensions(model, material, m, parts->scale * parts->metres);
        name_textures(textures, m, material);
        model.materials.push_back(material);
    }
}
