// openvdb.cpp: the bridge to OpenVDB, which is loaded where a .vdb is asked for.
#include "cli/grid/vdb.h"

// Static members of templates that this module and the library both have must be one object.
#pragma GCC visibility push(default)
#include <openvdb/io/Archive.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Prune.h>
#pragma GCC visibility pop

#include <cstring>
#include <ostream>
#include <streambuf>

namespace
{

struct File {
    VdbHow                  how;
    openvdb::FloatGrid::Ptr values;
    openvdb::Vec3SGrid::Ptr colors;
    openvdb::Int32Grid::Ptr materials;
};

openvdb::Coord coordinates(const VdbHow &how, const size_t at[3])
{
    return openvdb::Coord((int)(how.shape.first[0] + (int64_t)at[0]),
                          (int)(how.shape.first[1] + (int64_t)at[1]),
                          (int)(how.shape.first[2] + (int64_t)at[2]));
}

// Cells of files have their middle at whole multiples of their side.
template <typename Grid> void set_up(Grid &grid, const File &file, const char *name)
{
    grid.setName(name);
    grid.setSaveFloatAsHalf(file.how.half);
    grid.setTransform(openvdb::math::Transform::createLinearTransform(file.how.shape.cell));
}

void *begin(const VdbHow *how)
try {
    openvdb::initialize();
    File *file = new File{*how, nullptr, nullptr, nullptr};
    // No distance is longer than the band, also where it is rounded.
    float band   = (float)how->shape.band;
    band         = band > how->shape.band ? std::nextafter(band, 0.0f) : band;
    file->values = openvdb::FloatGrid::create(how->fog ? 0.0f : band);
    set_up(*file->values, *file, how->fog ? "density" : "surface");
    file->values->setGridClass(how->fog ? openvdb::GRID_FOG_VOLUME : openvdb::GRID_LEVEL_SET);
    if (how->color) {
        file->colors = openvdb::Vec3SGrid::create();
        set_up(*file->colors, *file, "Cd");
    }
    if (how->material) {
        file->materials = openvdb::Int32Grid::create();
        set_up(*file->materials, *file, "material");
    }
    return file;
} catch (...) {
    return nullptr;
}

// Far cells become tiles, which are solid, since those outside are the background.
void add_far(const File &file, const openvdb::Coord &origin, float value)
{
    openvdb::FloatTree &tree = file.values->tree();
    if (value == tree.background())
        return;
    // Bricks begin at whole multiples of their side, as leaves do.
    tree.addTile(1, origin, value, file.how.fog);
}

bool add(void *user, const KrsGridBrick *brick)
try {
    File                &file   = *static_cast<File *>(user);
    const openvdb::Coord origin = coordinates(file.how, brick->at);
    if (!brick->near) {
        add_far(file, origin, brick->values[0]);
        return true;
    }
    const float band   = file.values->background();
    auto       *leaf   = file.values->tree().touchLeaf(origin);
    auto       *colors = file.colors ? file.colors->tree().touchLeaf(origin) : nullptr;
    auto       *parts  = file.materials ? file.materials->tree().touchLeaf(origin) : nullptr;
    for (int i = 0; i < KRS_BRICK_SAMPLES; i++) {
        const openvdb::Coord at(i % 8, i / 8 % 8, i / 64);
        const auto           offset = openvdb::FloatTree::LeafNodeType::coordToOffset(at);
        const float          value  = brick->values[i];
        const bool           active = file.how.fog ? value > 0 : std::fabs(value) < band;
        active ? leaf->setValueOn(offset, value) : leaf->setValueOff(offset, value);
        if (colors && active)
            colors->setValueOn(offset, openvdb::Vec3s(brick->colors[i]));
        if (parts && active)
            parts->setValueOn(offset, (int)brick->materials[i]);
    }
    return true;
} catch (...) {
    return false;
}

// Bytes of a file that may be written in any order, with a name that is the same for equal grids: OpenVDB draws a
// random one, which stands behind 21 bytes of the header.
class Buffer : public std::streambuf
{
  public:
    Buffer(VdbSink *sink, void *user) : sink_(sink), user_(user) {}

  private:
    std::streamsize xsputn(const char *bytes, std::streamsize count) override
    {
        static const uint64_t begin = 21, end = begin + 36;
        std::string           own;
        if (at_ < end && at_ + (uint64_t)count > begin) {
            own.assign(bytes, (size_t)count);
            for (size_t i = 0; i < own.size(); i++)
                if (at_ + i >= begin && at_ + i < end && own[i] != '-')
                    own[i] = '0';
            bytes = own.data();
        }
        if (!sink_(user_, bytes, (size_t)count, at_))
            return 0;
        at_ += (uint64_t)count;
        return count;
    }
    int_type overflow(int_type byte) override
    {
        char one = traits_type::to_char_type(byte);
        return xsputn(&one, 1) == 1 ? byte : traits_type::eof();
    }
    pos_type seekoff(off_type offset, std::ios_base::seekdir from, std::ios_base::openmode) override
    {
        return seekpos(from == std::ios_base::cur ? (off_type)at_ + offset : offset,
                       std::ios_base::out);
    }
    pos_type seekpos(pos_type to, std::ios_base::openmode) override
    {
        at_ = (uint64_t)(off_type)to;
        return to;
    }

    VdbSink *sink_;
    void    *user_;
    uint64_t at_ = 0;
};

class Archive : public openvdb::io::Archive
{
  public:
    void write_to(std::ostream &stream, const openvdb::GridCPtrVec &grids) const
    {
        openvdb::io::Archive::write(stream, grids, true);
    }
};

bool write(void *user, VdbSink *sink, void *of)
try {
    File                &file = *static_cast<File *>(user);
    openvdb::GridCPtrVec grids;
    openvdb::tools::prune(file.values->tree());
    grids.push_back(file.values);
    if (file.colors)
        grids.push_back(file.colors);
    if (file.materials)
        grids.push_back(file.materials);
    Buffer       buffer(sink, of);
    std::ostream stream(&buffer);
    stream.exceptions(std::ios_base::badbit | std::ios_base::failbit);
    Archive().write_to(stream, grids);
    return true;
} catch (...) {
    return false;
}

void end(void *user) { delete static_cast<File *>(user); }

} // namespace

extern "C" __attribute__((visibility("default")))
const VdbModule krs_vdb_module = {begin, add, write, end};
