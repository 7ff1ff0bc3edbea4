// glb.cpp: the bridge to tinygltf.
#include "cli/mesh/glb_materials.h"

#include <cmath>
#include <cstring>
#include <sstream>

namespace
{

double linear_of(unsigned char byte)
{
    double encoded = byte / 255.0;
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

template <typename Number> void append(std::vector<unsigned char> &bytes, Number number)
{
    const unsigned char *begin = reinterpret_cast<const unsigned char *>(&number);
    bytes.insert(bytes.end(), begin, begin + sizeof number);
}

// Adds an accessor for what is appended to the only buffer from here on.
tinygltf::Accessor &add_accessor(tinygltf::Model &model, int target, int component, int type,
                                 size_t count)
{
    tinygltf::BufferView view;
    tinygltf::Accessor   accessor;
    view.buffer            = 0;
    view.byteOffset        = model.buffers[0].data.size();
    view.target            = target;
    accessor.bufferView    = (int)model.bufferViews.size();
    accessor.componentType = component;
    accessor.type          = type;
    accessor.count         = count;
    model.bufferViews.push_back(view);
    model.accessors.push_back(accessor);
    return model.accessors.back();
}

int end_accessor(tinygltf::Model &model)
{
    tinygltf::BufferView &view = model.bufferViews.back();
    view.byteLength            = model.buffers[0].data.size() - view.byteOffset;
    while (model.buffers[0].data.size() % 4 != 0)
        model.buffers[0].data.push_back(0);
    return (int)model.accessors.size() - 1;
}

// The accessors written for a part, for parts of the same vertices and triangles that are painted
// otherwise.
struct Written {
    const MeshPart *part;
    bool            mirrored;
    int             positions, triangles; // of all triangles; -1: they are of several materials
};

// A file that is being made.
struct File {
    tinygltf::Model      model;
    std::vector<Written> written;
};

bool is_same_shape(const MeshParts *parts, const MeshPart &a, const MeshPart &b)
{
    if (a.vertex_count != b.vertex_count || a.triangle_count != b.triangle_count ||
        std::memcmp(parts->vertices + a.first_vertex, parts->vertices + b.first_vertex,
                    a.vertex_count * sizeof *parts->vertices) != 0)
        return false;
    for (size_t t = 0; t < a.triangle_count; t++)
        for (int k = 0; k < 3; k++)
            if (parts->triangles[a.first_triangle + t][k] - a.first_vertex !=
                parts->triangles[b.first_triangle + t][k] - b.first_vertex)
                return false;
    return true;
}

// Finds a part of the same shape; nullptr: there is none.
const Written *find_written(const File &file, const MeshParts *parts, const MeshPart &part,
                            bool mirrored)
{
    for (const Written &written : file.written)
        if (written.mirrored == mirrored && is_same_shape(parts, *written.part, part))
            return &written;
    return nullptr;
}

// A mirrored part is its image in the plane x = 0.
int add_positions(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part,
                  bool mirrored)
{
    double              scale    = parts->scale * parts->metres;
    tinygltf::Accessor &accessor = add_accessor(model, TINYGLTF_TARGET_ARRAY_BUFFER,
                                                TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                                part.vertex_count);
    accessor.minValues.assign(3, HUGE_VAL);
    accessor.maxValues.assign(3, -HUGE_VAL);
    for (size_t i = part.first_vertex; i < part.first_vertex + part.vertex_count; i++)
        for (int k = 0; k < 3; k++) {
            double side           = mirrored && k == 0 ? -scale : scale;
            float  number         = (float)(side * parts->vertices[i][k]);
            accessor.minValues[k] = std::fmin(accessor.minValues[k], number);
            accessor.maxValues[k] = std::fmax(accessor.maxValues[k], number);
            append(model.buffers[0].data, number);
        }
    return end_accessor(model);
}

// Adds linear colors of sixteen bits; the fourth number is for alignment.
int add_colors(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part)
{
    add_accessor(model, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT,
                 TINYGLTF_TYPE_VEC4, part.vertex_count)
        .normalized = true;
    for (size_t i = part.first_vertex; i < part.first_vertex + part.vertex_count; i++) {
        for (int k = 0; k < 3; k++)
            append(model.buffers[0].data,
                   (uint16_t)std::lrint(65535 * linear_of(parts->colors[i][k])));
        append(model.buffers[0].data, (uint16_t)65535);
    }
    return end_accessor(model);
}

// Adds places in the texture, whose v goes down in glTF.
int add_places(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part)
{
    add_accessor(model, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_FLOAT,
                 TINYGLTF_TYPE_VEC2, part.vertex_count);
    for (size_t i = part.first_vertex; i < part.first_vertex + part.vertex_count; i++) {
        append(model.buffers[0].data, (float)parts->vertex_places[i][0]);
        append(model.buffers[0].data, (float)(1 - parts->vertex_places[i][1]));
    }
    return end_accessor(model);
}

// Adds normals.  Vertices without a frame are those of triangles that need none.
int add_normals(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part, bool mirrored)
{
    add_accessor(model, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_FLOAT,
                 TINYGLTF_TYPE_VEC3, part.vertex_count);
    for (size_t i = part.first_vertex; i < part.first_vertex + part.vertex_count; i++) {
        const float *n    = parts->vertex_frames[i].normal;
        bool         none = n[0] == 0 && n[1] == 0 && n[2] == 0;
        append(model.buffers[0].data, mirrored ? -n[0] : n[0]);
        append(model.buffers[0].data, n[1]);
        append(model.buffers[0].data, none ? 1.0f : n[2]);
    }
    return end_accessor(model);
}

int add_tangents(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part,
                 bool mirrored)
{
    add_accessor(model, TINYGLTF_TARGET_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_FLOAT,
                 TINYGLTF_TYPE_VEC4, part.vertex_count);
    for (size_t i = part.first_vertex; i < part.first_vertex + part.vertex_count; i++) {
        const float *t    = parts->vertex_frames[i].tangent;
        bool         none = t[0] == 0 && t[1] == 0 && t[2] == 0;
        append(model.buffers[0].data, none ? 1.0f : mirrored ? -t[0] : t[0]);
        append(model.buffers[0].data, t[1]);
        append(model.buffers[0].data, t[2]);
        append(model.buffers[0].data, 1.0f);
    }
    return end_accessor(model);
}

int add_triangles(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part,
                  uint32_t material, bool mirrored)
{
    size_t count = 0, end = part.first_triangle + part.triangle_count;
    for (size_t i = part.first_triangle; i < end; i++)
        count += parts->material_of[i] == material;
    if (count == 0)
        return -1;
    add_accessor(model, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT,
                 TINYGLTF_TYPE_SCALAR, 3 * count);
    for (size_t i = part.first_triangle; i < end; i++)
        for (int k = 0; k < 3 && parts->material_of[i] == material; k++) {
            int corner = mirrored && k > 0 ? 3 - k : k;
            append(model.buffers[0].data,
                   (uint32_t)(parts->triangles[i][corner] - part.first_vertex));
        }
    return end_accessor(model);
}

// Writes normals and tangents when a primitive first needs them.
void put_frames(tinygltf::Model &model, const MeshParts *parts, const MeshPart &part, bool mirrored,
                int frames[2], tinygltf::Primitive &primitive)
{
    if (frames[0] < 0) {
        frames[0] = add_normals(model, parts, part, mirrored);
        frames[1] = add_tangents(model, parts, part, mirrored);
    }
    primitive.attributes["NORMAL"]  = frames[0];
    primitive.attributes["TANGENT"] = frames[1];
}

// Tells whether a part needs places in a texture: with pictures, if one shows something of it.
bool needs_places(const MeshParts *parts, const MeshPart &part)
{
    bool needs = parts->vertex_places && !parts->pictures;
    for (size_t i = 0; i < part.triangle_count && parts->pictures; i++)
        needs = needs ||
                mesh_is_baked(&parts->materials[parts->material_of[part.first_triangle + i]]);
    return needs;
}

bool has_one_material(const MeshParts *parts, const MeshPart &part)
{
    for (size_t i = 0; i < part.triangle_count; i++)
        if (parts->material_of[part.first_triangle + i] != parts->material_of[part.first_triangle])
            return false;
    return part.triangle_count > 0;
}

int add_mesh(File &file, const MeshParts *parts, const MeshPart &part, bool mirrored,
             const char *name)
{
    tinygltf::Model &model = file.model;
    tinygltf::Mesh   mesh;
    const Written   *same   = find_written(file, parts, part, mirrored);
    bool             single = has_one_material(parts, part);
    Written          now    = {&part, mirrored, same ? same->positions : -1, -1};
    int              colors = -1, frames[2] = {-1, -1};
    if (!same)
        now.positions = add_positions(model, parts, part, mirrored);
    int places = needs_places(parts, part) ? add_places(model, parts, part) : -1;
    for (uint32_t material = 0; material < parts->material_count; material++) {
        int triangles = single && same && same->triangles >= 0 &&
                                material == parts->material_of[part.first_triangle]
                            ? same->triangles
                            : add_triangles(model, parts, part, material, mirrored);
        if (triangles < 0)
            continue;
        if (single)
            now.triangles = triangles;
        tinygltf::Primitive primitive;
        primitive.attributes["POSITION"] = now.positions;
        const MeshMaterial &m            = parts->materials[material];
        if (!m.even && !m.baked[PICTURE_COLOR]) {
            colors                          = colors < 0 ? add_colors(model, parts, part) : colors;
            primitive.attributes["COLOR_0"] = colors;
        }
        if (places >= 0 && (!parts->pictures || mesh_is_baked(&m)))
            primitive.attributes["TEXCOORD_0"] = places;
        if (mesh_needs_frames(&m))
            put_frames(model, parts, part, mirrored, frames, primitive);
        primitive.indices  = triangles;
        primitive.material = (int)material;
        primitive.mode     = TINYGLTF_MODE_TRIANGLES;
        mesh.primitives.push_back(primitive);
    }
    file.written.push_back(now);
    mesh.name = name;
    model.meshes.push_back(mesh);
    return (int)model.meshes.size() - 1;
}

int add_node(tinygltf::Model &model, const tinygltf::Node &node)
{
    model.nodes.push_back(node);
    return (int)model.nodes.size() - 1;
}

// Copies of a part, and of its image in the plane x = 0: by that no copy is a reflection, of which
// instances must not be, since all triangles that are drawn together face to one side.
struct Copy {
    MeshPose         pose;
    const MeshTrack *track; // nullptr: it stands still
};

struct Copies {
    std::vector<Copy> still[2], moving[2];
};

// The copies of each item of an assembly.
struct Collection {
    const MeshBody     *body;
    std::vector<Copies> items;
    size_t              count;
};

bool collect(void *user, const KrsItem *item, const double matrix[3][4])
{
    Collection *collection = (Collection *)user;
    Copies     &copies     = collection->items[item - collection->body->assembly->items];
    Copy        copy       = {};
    mesh_pose_of(matrix, &copy.pose);
    if (collection->body->tracks)
        copy.track = &collection->body->tracks[collection->count++];
    bool moves = copy.track && copy.track->count > 1;
    (moves ? copies.moving : copies.still)[copy.pose.mirrored].push_back(copy);
    return true;
}

// The times of the last keyframes that were written, which others often share.
struct Times {
    std::vector<float> seconds;
    int                accessor = -1;
};

int add_times(tinygltf::Model &model, const MeshTrack &track, Times &times)
{
    std::vector<float> seconds;
    for (size_t i = 0; i < track.count; i++)
        seconds.push_back((float)track.keys[i].time);
    if (times.accessor >= 0 && seconds == times.seconds)
        return times.accessor;
    tinygltf::Accessor &accessor = add_accessor(model, 0, TINYGLTF_COMPONENT_TYPE_FLOAT,
                                                TINYGLTF_TYPE_SCALAR, track.count);
    accessor.minValues.assign(1, seconds.front());
    accessor.maxValues.assign(1, seconds.back());
    for (float second : seconds)
        append(model.buffers[0].data, second);
    times.seconds  = seconds;
    times.accessor = end_accessor(model);
    return times.accessor;
}

// Adds a channel for what a node has, unless it stays the same.
void add_channel(tinygltf::Model &model, int node, const MeshTrack &track, bool rotates,
                 double lengths, Times &times)
{
    std::vector<float> values;
    bool               stays = true;
    const size_t       width = rotates ? 4 : 3;
    for (size_t i = 0; i < track.count; i++)
        for (size_t k = 0; k < width; k++) {
            const MeshPose &pose = track.keys[i].pose;
            values.push_back((float)(rotates ? pose.rotation[k] : lengths * pose.translation[k]));
            stays = stays && values.back() == values[k];
        }
    if (stays)
        return;
    tinygltf::Animation       &animation = model.animations[0];
    tinygltf::AnimationSampler sampler;
    tinygltf::AnimationChannel channel;
    sampler.input         = add_times(model, track, times);
    sampler.interpolation = "LINEAR";
    add_accessor(model, 0, TINYGLTF_COMPONENT_TYPE_FLOAT,
                 rotates ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3, track.count);
    for (float value : values)
        append(model.buffers[0].data, value);
    sampler.output      = end_accessor(model);
    channel.sampler     = (int)animation.samplers.size();
    channel.target_node = node;
    channel.target_path = rotates ? "rotation" : "translation";
    animation.samplers.push_back(sampler);
    animation.channels.push_back(channel);
}

void animate(tinygltf::Model &model, int node, const MeshTrack &track, double lengths, Times &times)
{
    if (model.animations.empty()) {
        model.animations.emplace_back();
        model.animations[0].name = "frames";
    }
    add_channel(model, node, track, false, lengths, times);
    add_channel(model, node, track, true, lengths, times);
}

// Adds a node for each copy.
void place_by_nodes(tinygltf::Model &model, int mesh, const std::vector<Copy> &copies,
                    double lengths, tinygltf::Node &body)
{
    Times times;
    for (const Copy &copy : copies) {
        tinygltf::Node  node;
        const MeshPose &pose = copy.pose;
        node.mesh            = mesh;
        node.name            = model.meshes[mesh].name;
        for (double along : pose.translation)
            node.translation.push_back(lengths * along);
        node.rotation.assign(pose.rotation, pose.rotation + 4);
        node.scale.assign(3, pose.scale);
        body.children.push_back(add_node(model, node));
        if (copy.track && copy.track->count > 1)
            animate(model, body.children.back(), *copy.track, lengths, times);
    }
}

int add_instances(tinygltf::Model &model, const std::vector<Copy> &copies, int member,
                  double lengths)
{
    int type = member == 1 ? TINYGLTF_TYPE_VEC4 : TINYGLTF_TYPE_VEC3;
    add_accessor(model, 0, TINYGLTF_COMPONENT_TYPE_FLOAT, type, copies.size());
    for (const Copy &copy : copies)
        for (int k = 0; k < (member == 1 ? 4 : 3); k++)
            append(model.buffers[0].data, (float)(member == 0   ? lengths * copy.pose.translation[k]
                                                  : member == 1 ? copy.pose.rotation[k]
                                                                : copy.pose.scale));
    return end_accessor(model);
}

// Writes one node with all copies, by the extension EXT_mesh_gpu_instancing.
void place_by_instances(tinygltf::Model &model, int mesh, const std::vector<Copy> &copies,
                        double lengths, tinygltf::Node &body)
{
    static const char *const names[]   = {"TRANSLATION", "ROTATION", "SCALE"};
    static const char *const extension = "EXT_mesh_gpu_instancing";
    tinygltf::Value::Object  attributes, content;
    tinygltf::Node           node;
    for (int member = 0; member < 3; member++)
        attributes[names[member]] = tinygltf::Value(add_instances(model, copies, member, lengths));
    content["attributes"]      = tinygltf::Value(attributes);
    node.mesh                  = mesh;
    node.name                  = model.meshes[mesh].name;
    node.extensions[extension] = tinygltf::Value(content);
    glb_use_extension(model.extensionsRequired, extension);
    glb_use_extension(model.extensionsUsed, extension);
    body.children.push_back(add_node(model, node));
}

const double MAX_NODES = 1024; // for copies that stand still; more are instances

void add_copies(File &file, const MeshParts *parts, const MeshBody &body, tinygltf::Node &node)
{
    const KrsAssembly *assembly   = body.assembly;
    const double       lengths    = parts->scale * parts->metres;
    Collection         collection = {&body, std::vector<Copies>(assembly->item_count), 0};
    krs_assembly_visit(assembly, collect, &collection);
    for (size_t i = 0; i < assembly->item_count; i++)
        for (int mirrored = 0; mirrored < 2; mirrored++) {
            const std::vector<Copy> &still  = collection.items[i].still[mirrored];
            const std::vector<Copy> &moving = collection.items[i].moving[mirrored];
            const MeshPart          &part   = parts->parts[body.part_of[i]];
            if ((still.empty() && moving.empty()) || part.triangle_count == 0)
                continue;
            const char *name = assembly->items[i].name ? assembly->items[i].name : body.name;
            int         mesh = add_mesh(file, parts, part, mirrored != 0, name);
            place_by_nodes(file.model, mesh, moving, lengths, node);
            if (assembly->copies <= MAX_NODES)
                place_by_nodes(file.model, mesh, still, lengths, node);
            else if (!still.empty())
                place_by_instances(file.model, mesh, still, lengths, node);
        }
}

// Puts levels of detail into a node: it has them from tinygltf 2.9 on, which then knows them from
// nowhere else.
template <typename Node>
auto put_in_lods(Node &node, const std::vector<int> &ids, int) -> decltype((void)node.lods)
{
    node.lods = ids;
}

template <typename Node> void put_in_lods(Node &node, const std::vector<int> &ids, long)
{
    tinygltf::Value::Array  values;
    tinygltf::Value::Object content;
    for (int id : ids)
        values.push_back(tinygltf::Value(id));
    content["ids"]              = tinygltf::Value(values);
    node.extensions["MSFT_lod"] = tinygltf::Value(content);
}

// Adds a node for each further level of detail, which the extension MSFT_lod names.  No scene has
// them: a program without it shows the first level.
void add_lods(File &file, const MeshParts *parts, const MeshBody &body, tinygltf::Node &node)
{
    std::vector<int>        ids;
    tinygltf::Value::Array  coverages;
    tinygltf::Value::Object extras;
    double                  coverage = 0.5;
    for (size_t i = 1; i <= body.lod_count; i++, coverage /= 4) {
        tinygltf::Node level;
        level.name = body.name;
        level.mesh = add_mesh(file, parts, parts->parts[body.first_part + i], false, body.name);
        ids.push_back(add_node(file.model, level));
        coverages.push_back(tinygltf::Value(coverage));
    }
    coverages.push_back(tinygltf::Value(0.0));
    extras["MSFT_screencoverage"] = tinygltf::Value(coverages);
    node.extras                   = tinygltf::Value(extras);
    put_in_lods(node, ids, 0);
    glb_use_extension(file.model.extensionsUsed, "MSFT_lod");
}

void add_body(File &file, const MeshParts *parts, const MeshBody &body)
{
    tinygltf::Node node;
    node.name = body.name;
    if (body.assembly)
        add_copies(file, parts, body, node);
    else
        node.mesh = add_mesh(file, parts, parts->parts[body.first_part], false, body.name);
    if (body.lod_count > 0)
        add_lods(file, parts, body, node);
    file.model.scenes[0].nodes.push_back(add_node(file.model, node));
}

// A stream whose bytes go to the sink.
class SinkStream : public std::streambuf
{
  public:
    SinkStream(MeshSink *to, void *user) : sink(to), data(user) {}

  protected:
    std::streamsize xsputn(const char *bytes, std::streamsize count) override
    {
        return sink(data, bytes, (size_t)count) ? count : 0;
    }
    int overflow(int byte) override
    {
        char one = (char)byte;
        return byte != EOF && sink(data, &one, 1) ? byte : EOF;
    }

  private:
    MeshSink *sink;
    void     *data;
};

} // namespace

bool mesh_bridge_glb(const MeshParts *parts, MeshSink *sink, void *user)
{
    try {
        File             file  = {};
        tinygltf::Model &model = file.model;
        SinkStream       bytes(sink, user);
        std::ostream     stream(&bytes);
        model.asset.version   = "2.0";
        model.asset.generator = "krs";
        model.buffers.resize(1);
        model.scenes.resize(1);
        model.defaultScene = 0;
        glb_add_materials(model, parts);
        for (size_t i = 0; i < parts->body_count; i++)
            add_body(file, parts, parts->bodies[i]);
        return tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true) &&
               stream.good();
    } catch (...) {
        return false;
    }
}
