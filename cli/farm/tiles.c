/*
 * tiles.c: EXR files of `krs render` that are parts of one picture, as one picture.
 *
 * What the writer of pictures was given is read back: samples as they are stored, texts in their order, matrices.  So
 * it writes the same bytes as for a picture that was rendered at once.
 */
#include "cli/farm/tiles.h"
#include "cli/farm/ranges.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "cli/picture/sample_sums.h"
#include "cli/shell/console.h"
#include "cli/shell/supervise.h"
#include "compiler/base/exr_chunks.h"
#include "runtime/writer/exr.h"

static const char *const matrix_names[2] = {"worldToCamera", "worldToNDC"};

/* A file of them. */
typedef struct Tile {
    const char      *path;
    exr_context_t    context;
    exr_attr_box2i_t data, display;
    Tiles            header; /* without pixels */
    SampleRange      range;
    bool             begins; /* of those with its part of the picture it has the first samples */
} Tile;

typedef struct Reading {
    const Options   *options;
    Tile            *tiles;
    size_t           count;
    exr_attr_box2i_t whole; /* what they have together */
    Tiles           *result;
    uint32_t         first, last; /* samples that they have together, if they are divided */
    RangeSums        sums;

    /* where the pixels of the file that is read go */
    const Tiles     *target;
    exr_attr_box2i_t box;
    const Tile      *now;
} Reading;

static KrsStatus say_fault(const char *path, exr_result_t result)
{
    say("cannot read `%s`: %s", path, exr_chunks_fault(result));
    return result == EXR_ERR_OUT_OF_MEMORY ? KRS_OUT_OF_MEMORY : KRS_IO_ERROR;
}

static KrsStatus say_unusable(const char *path, const char *what)
{
    say("cannot merge `%s`: %s", path, what);
    return KRS_IO_ERROR;
}

/* ---- headers ---- */

static int by_place(const void *first, const void *second)
{
    const Tile *a = first, *b = second;
    const long  before[3] = {a->data.min.y, a->data.min.x, a->range.first};
    const long  behind[3] = {b->data.min.y, b->data.min.x, b->range.first};
    for (int i = 0; i < 3; i++)
        if (before[i] != behind[i])
            return before[i] < behind[i] ? -1 : 1;
    return 0;
}

static const char *copy(const Options *options, const exr_attr_string_t *text)
{
    return arena_copy_text(options->arena, text->str, (size_t)text->length);
}

static void read_channels(const Options *options, Tile *tile, const exr_attr_chlist_t *list)
{
    static const SampleType types[] = {[EXR_PIXEL_UINT]  = SAMPLE_UINT,
                                       [EXR_PIXEL_HALF]  = SAMPLE_HALF,
                                       [EXR_PIXEL_FLOAT] = SAMPLE_FLOAT};
    tile->header.channels           = arena_new_array(options->arena, PictureChannel,
                                                      (size_t)list->num_channels);
    for (int i = 0; i < list->num_channels; i++)
        tile->header.channels[i] = (PictureChannel){.name   = copy(options, &list->entries[i].name),
                                                    .type   = types[list->entries[i].pixel_type],
                                                    .stride = 1};
    tile->header.picture.channel_count = (size_t)list->num_channels;
}

static void read_attribute(const Options *options, Tile *tile, const exr_attribute_t *attribute)
{
    Tiles *header = &tile->header;
    if (attribute->type == EXR_ATTR_CHLIST)
        read_channels(options, tile, attribute->chlist);
    const bool of_the_part = strcmp(attribute->name, "name") == 0 ||
                             strcmp(attribute->name, "type") == 0;
    if (attribute->type == EXR_ATTR_STRING && !of_the_part)
        header->texts[header->picture.text_count++] = (PictureText){
            arena_copy_text(options->arena, attribute->name, strlen(attribute->name)),
            copy(options, attribute->string)};
    for (size_t i = 0; i < 2; i++)
        if (attribute->type == EXR_ATTR_M44F && strcmp(attribute->name, matrix_names[i]) == 0) {
            header->has[i] = true;
            memcpy(header->matrices[i].m, attribute->m44f->m, sizeof header->matrices[i].m);
        }
}

static KrsStatus read_header(const Options *options, Tile *tile)
{
    exr_storage_t          storage;
    int32_t                count;
    const exr_attribute_t *attribute;
    if (exr_get_storage(tile->context, 0, &storage) != EXR_ERR_SUCCESS ||
        storage != EXR_STORAGE_SCANLINE ||
        exr_get_data_window(tile->context, 0, &tile->data) != EXR_ERR_SUCCESS ||
        exr_get_display_window(tile->context, 0, &tile->display) != EXR_ERR_SUCCESS ||
        exr_get_attribute_count(tile->context, 0, &count) != EXR_ERR_SUCCESS ||
        tile->display.min.x != 0 || tile->display.min.y != 0 ||
        tile->display.max.x >= KRS_MAX_SIDE || tile->display.max.y >= KRS_MAX_SIDE ||
        tile->data.min.x < 0 || tile->data.min.y < 0 || tile->data.max.x > tile->display.max.x ||
        tile->data.max.y > tile->display.max.y)
        return say_unusable(tile->path, "`krs render` has not written it");
    tile->header.texts = arena_new_array(options->arena, PictureText, (size_t)count);
    for (int32_t i = 0; i < count; i++)
        if (exr_get_attribute_by_index(tile->context, 0, EXR_ATTR_LIST_FILE_ORDER, i, &attribute) ==
            EXR_ERR_SUCCESS)
            read_attribute(options, tile, attribute);
    if (tile->header.picture.channel_count == 0)
        return say_unusable(tile->path, "it has no channels");
    tile->header.picture.channels = tile->header.channels;
    tile->header.picture.texts    = tile->header.texts;
    const char *wrong             = range_read(&tile->header.picture, &tile->range);
    return wrong ? say_unusable(tile->path, wrong) : KRS_OK;
}

/* ---- whether they are of one picture ---- */

/* Tells whether a text names what is seen in a part: a manifest of Cryptomatte. */
static bool is_manifest(const char *name)
{
    const char *slash = strrchr(name, '/');
    return strncmp(name, "cryptomatte/", 12) == 0 && slash && strcmp(slash, "/manifest") == 0;
}

static bool may_differ(const char *name)
{
    return is_manifest(name) || strcmp(name, SAMPLES_TEXT) == 0;
}

static bool same_texts(const Tiles *a, const Tiles *b, const char **different)
{
    *different = NULL;
    if (a->picture.text_count != b->picture.text_count)
        return false;
    for (size_t i = 0; i < a->picture.text_count; i++)
        if (strcmp(a->texts[i].name, b->texts[i].name) != 0 ||
            (!may_differ(a->texts[i].name) && strcmp(a->texts[i].value, b->texts[i].value) != 0)) {
            *different = a->texts[i].name;
            return false;
        }
    return true;
}

static bool same_channels(const Tiles *a, const Tiles *b)
{
    bool same = a->picture.channel_count == b->picture.channel_count;
    for (size_t i = 0; i < a->picture.channel_count && same; i++)
        same = a->channels[i].type == b->channels[i].type &&
               strcmp(a->channels[i].name, b->channels[i].name) == 0;
    return same;
}

static bool has_channel(const Tiles *tiles, const PictureChannel *channel)
{
    for (size_t i = 0; i < tiles->picture.channel_count; i++)
        if (strcmp(tiles->channels[i].name, channel->name) == 0)
            return tiles->channels[i].type == channel->type;
    return false;
}

/* Files of the first samples have channels that others lack. */
static bool fit_channels(const Tile *a, const Tile *b)
{
    const Tiles *many = a->range.first == 0 ? &a->header : &b->header;
    const Tiles *few  = a->range.first == 0 ? &b->header : &a->header;
    if ((a->range.first == 0) == (b->range.first == 0))
        return same_channels(&a->header, &b->header);
    for (size_t i = 0; i < few->picture.channel_count; i++)
        if (!has_channel(many, &few->channels[i]))
            return false;
    return true;
}

static KrsStatus say_different(const Tile *a, const Tile *b, const char *what)
{
    say("cannot merge `%s` and `%s`: they are not of one render: %s", a->path, b->path, what);
    return KRS_IO_ERROR;
}

static KrsStatus check_alike(const Tile *a, const Tile *b)
{
    const char *different;
    if (a->display.max.x != b->display.max.x || a->display.max.y != b->display.max.y)
        return say_different(a, b, "their pictures have other sizes");
    if (a->range.divided != b->range.divided)
        return say_different(a, b, "one of them has some of the samples, one all");
    if (a->range.all != b->range.all)
        return say_different(a, b, "their samples are of other numbers");
    if (!fit_channels(a, b))
        return say_different(a, b, "they have other channels");
    if (!same_texts(&a->header, &b->header, &different))
        return say_different(a, b, different ? different : "they have other attributes");
    if (memcmp(a->header.has, b->header.has, sizeof a->header.has) != 0 ||
        memcmp(a->header.matrices, b->header.matrices, sizeof a->header.matrices) != 0)
        return say_different(a, b, "they have other cameras");
    return KRS_OK;
}

static bool overlap(const exr_attr_box2i_t *a, const exr_attr_box2i_t *b)
{
    return a->min.x <= b->max.x && b->min.x <= a->max.x && a->min.y <= b->max.y &&
           b->min.y <= a->max.y;
}

static size_t area(const exr_attr_box2i_t *box)
{
    return (size_t)(box->max.x - box->min.x + 1) * (size_t)(box->max.y - box->min.y + 1);
}

static bool same_box(const exr_attr_box2i_t *a, const exr_attr_box2i_t *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

/* Tells whether a file has later samples of the same pixels. */
static bool follows(const Tile *before, const Tile *tile)
{
    return tile->range.divided && same_box(&before->data, &tile->data) &&
           before->range.last < tile->range.first;
}

static KrsStatus say_missing(const Tile *tile, uint32_t first, uint32_t last)
{
    say("cannot merge: of the part that `%s` has, samples %u to %u are missing", tile->path, first,
        last);
    return KRS_IO_ERROR;
}

/* Checks that each part of the picture has the same samples, without a hole.  Files are in the order of these. */
static KrsStatus check_ranges(Reading *r)
{
    r->first = UINT32_MAX;
    for (size_t i = 0; i < r->count; i++) {
        Tile *tile   = &r->tiles[i];
        tile->begins = i == 0 || !same_box(&tile->data, &tile[-1].data);
        r->first     = tile->range.first < r->first ? tile->range.first : r->first;
        r->last      = tile->range.last > r->last ? tile->range.last : r->last;
    }
    for (size_t i = 0; i < r->count; i++) {
        const Tile    *tile = &r->tiles[i];
        const bool     ends = i + 1 == r->count || tile[1].begins;
        const uint32_t due  = tile->begins ? r->first : tile[-1].range.last + 1;
        if (tile->range.first > due)
            return say_missing(tile, due, tile->range.first - 1);
        if (ends && tile->range.last < r->last)
            return say_missing(tile, tile->range.last + 1, r->last);
    }
    return KRS_OK;
}

/* Checks that they fill a rectangle, each pixel by one of them. */
static KrsStatus check_places(Reading *r)
{
    size_t pixels = 0;
    r->whole      = r->tiles[0].data;
    for (size_t i = 0; i < r->count; i++) {
        const exr_attr_box2i_t *data = &r->tiles[i].data;
        r->whole.min.x               = data->min.x < r->whole.min.x ? data->min.x : r->whole.min.x;
        r->whole.min.y               = data->min.y < r->whole.min.y ? data->min.y : r->whole.min.y;
        r->whole.max.x               = data->max.x > r->whole.max.x ? data->max.x : r->whole.max.x;
        r->whole.max.y               = data->max.y > r->whole.max.y ? data->max.y : r->whole.max.y;
        pixels += r->tiles[i].begins ? area(data) : 0;
        for (size_t k = 0; k < i; k++)
            if (overlap(data, &r->tiles[k].data) && !follows(&r->tiles[k], &r->tiles[i])) {
                say("cannot merge `%s` and `%s`: both have pixels at %d, %d", r->tiles[k].path,
                    r->tiles[i].path,
                    data->min.x > r->tiles[k].data.min.x ? data->min.x : r->tiles[k].data.min.x,
                    data->min.y > r->tiles[k].data.min.y ? data->min.y : r->tiles[k].data.min.y);
                return KRS_IO_ERROR;
            }
    }
    if (pixels == area(&r->whole))
        return KRS_OK;
    say("cannot merge: %zu pixels between the files are missing", area(&r->whole) - pixels);
    return KRS_IO_ERROR;
}

/* ---- samples ---- */

/* Says that the lines of a chunk go to their place in the planes of the target. */
static void place_lines(void *user, exr_decode_pipeline_t *pipeline)
{
    const Reading *r     = user;
    const size_t   width = (size_t)(r->box.max.x - r->box.min.x + 1);
    const size_t   row   = (size_t)(pipeline->chunk.start_y - r->box.min.y);
    const size_t   first = row * width + (size_t)(r->now->data.min.x - r->box.min.x);
    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        size_t                     i       = 0;
        while (strcmp(r->target->channels[i].name, channel->channel_name) != 0)
            i++;
        channel->decode_to_ptr          = (uint8_t *)(r->target->planes[i] + first);
        channel->user_bytes_per_element = 4;
        channel->user_data_type         = channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT
                                                                               : EXR_PIXEL_FLOAT;
        channel->user_pixel_stride      = 4;
        channel->user_line_stride       = (int32_t)(4 * width);
    }
}

static void take_nothing(void *user, const exr_decode_pipeline_t *pipeline)
{
    (void)user, (void)pipeline;
}

static KrsStatus read_samples(Reading *r)
{
    const ExrChunks chunks = {r->now->context, r->now->data, place_lines, take_nothing, r};
    int32_t         lines  = 0;
    exr_result_t    result = exr_get_scanlines_per_chunk(r->now->context, 0, &lines);
    if (result == EXR_ERR_SUCCESS)
        result = exr_chunks_read(&chunks, lines);
    return result == EXR_ERR_SUCCESS ? KRS_OK : say_fault(r->now->path, result);
}

/* Returns all names that the manifests of that number have, by themselves.  What is no manifest counts as empty. */
static const char *merge_manifests(const Reading *r, size_t number)
{
    json_t *all = json_object();
    for (size_t i = 0; i < r->count; i++) {
        json_t *names = json_loads(r->tiles[i].header.texts[number].value, 0, NULL);
        json_object_update(all, names);
        json_decref(names);
    }
    char       *text   = json_dumps(all, JSON_SORT_KEYS);
    const char *merged = text ? arena_copy_text(r->options->arena, text, strlen(text)) : "{}";
    free(text);
    json_decref(all);
    return merged;
}

/* Makes room for the samples of all channels. */
static KrsStatus allocate_planes(const Options *options, Tiles *tiles, size_t pixels,
                                 const char *path)
{
    const size_t count = tiles->picture.channel_count;
    tiles->planes      = arena_new_array(options->arena, float *, count);
    memset(tiles->planes, 0, count * sizeof *tiles->planes);
    for (size_t i = 0; i < count; i++) {
        tiles->planes[i] = malloc(pixels * sizeof(float));
        if (!tiles->planes[i])
            return say_status(KRS_OUT_OF_MEMORY, path);
        tiles->channels[i].samples = tiles->planes[i];
    }
    return KRS_OK;
}

/* Makes the picture of all files, as that of the first. */
static KrsStatus make_picture(Reading *r)
{
    Tiles   *tiles           = r->result;
    Picture *picture         = &tiles->picture;
    *tiles                   = r->tiles[0].header;
    picture->width           = (uint32_t)r->tiles[0].display.max.x + 1;
    picture->height          = (uint32_t)r->tiles[0].display.max.y + 1;
    picture->crop_x          = (uint32_t)r->whole.min.x;
    picture->crop_y          = (uint32_t)r->whole.min.y;
    picture->crop_width      = (uint32_t)(r->whole.max.x - r->whole.min.x + 1);
    picture->crop_height     = (uint32_t)(r->whole.max.y - r->whole.min.y + 1);
    picture->channels        = tiles->channels;
    picture->texts           = tiles->texts;
    picture->world_to_camera = tiles->has[0] ? &tiles->matrices[0] : NULL;
    picture->world_to_ndc    = tiles->has[1] ? &tiles->matrices[1] : NULL;
    for (size_t i = 0; i < picture->text_count; i++)
        if (is_manifest(tiles->texts[i].name))
            tiles->texts[i].value = merge_manifests(r, i);
    const KrsStatus status = allocate_planes(r->options, tiles, area(&r->whole), r->tiles[0].path);
    if (status != KRS_OK)
        return status;
    r->target = tiles;
    r->box    = r->whole;
    return !r->tiles[0].range.divided || ranges_new(&r->sums, area(&r->whole))
               ? KRS_OK
               : say_status(KRS_OUT_OF_MEMORY, r->tiles[0].path);
}

static bool is_of_range(const char *name)
{
    static const char *const texts[SAMPLE_TEXTS] = {SAMPLES_TEXT, SETTINGS_TEXT};
    for (size_t i = 0; i < SAMPLE_TEXTS; i++)
        if (strcmp(name, texts[i]) == 0)
            return true;
    return strncmp(name, SUM_LAYER, strlen(SUM_LAYER)) == 0;
}

/* Leaves out of a picture that has all samples what those of some have. */
static void drop_ranges(Tiles *tiles)
{
    Picture *picture = &tiles->picture;
    size_t   texts = 0, channels = 0;
    for (size_t i = 0; i < picture->text_count; i++)
        if (!is_of_range(tiles->texts[i].name))
            tiles->texts[texts++] = tiles->texts[i];
    for (size_t i = 0; i < picture->channel_count; i++)
        if (is_of_range(tiles->channels[i].name))
            free(tiles->planes[i]);
        else {
            tiles->planes[channels]     = tiles->planes[i];
            tiles->channels[channels++] = tiles->channels[i];
        }
    picture->text_count    = texts;
    picture->channel_count = channels;
}

/* Makes the picture of the sums of all files. */
static void finish_ranges(Reading *r)
{
    Tiles             *tiles = r->result;
    const SampleRange *range = &r->tiles[0].range;
    Text               text  = {.arena = r->options->arena};
    ranges_finish(&r->sums, area(&r->whole), r->first, r->last, range->noise, &tiles->picture,
                  tiles->planes);
    text_format(&text, "%u..%u/%u", r->first, r->last, range->all);
    for (size_t i = 0; i < tiles->picture.text_count; i++)
        if (strcmp(tiles->texts[i].name, SAMPLES_TEXT) == 0)
            tiles->texts[i].value = text.bytes;
    if (r->last - r->first + 1 == range->all)
        drop_ranges(tiles);
}

static KrsStatus read_tiles(Reading *r)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 1; i < r->count && status == KRS_OK; i++)
        status = check_alike(&r->tiles[0], &r->tiles[i]);
    if (status == KRS_OK)
        status = check_ranges(r);
    if (status == KRS_OK)
        status = check_places(r);
    if (status == KRS_OK)
        status = make_picture(r);
    return status;
}

/* Opens a file for as long as it is read: there may be more of them than a process can have open. */
static KrsStatus open_tile(Tile *tile)
{
    exr_context_initializer_t setup  = EXR_DEFAULT_CONTEXT_INITIALIZER;
    exr_result_t              result = exr_chunks_open(&tile->context, tile->path, setup);
    return result == EXR_ERR_SUCCESS ? KRS_OK : say_fault(tile->path, result);
}

/* Reads a file of some samples, and adds them to those of the picture. */
static KrsStatus add_range(Reading *r)
{
    const Tile *tile   = r->now;
    Tiles       own    = tile->header;
    const int   width  = tile->data.max.x - tile->data.min.x + 1;
    KrsStatus   status = allocate_planes(r->options, &own, area(&tile->data), tile->path);
    r->target          = &own;
    r->box             = tile->data;
    if (status == KRS_OK)
        status = read_samples(r);
    for (int y = tile->data.min.y; y <= tile->data.max.y && status == KRS_OK; y++) {
        const size_t from = (size_t)(y - tile->data.min.y) * (size_t)width;
        const size_t to   = (size_t)(y - r->whole.min.y) * r->result->picture.crop_width +
                          (size_t)(tile->data.min.x - r->whole.min.x);
        ranges_add(&r->sums, to, (size_t)width, &tile->range, &own.picture, own.planes, from,
                   tile->begins);
        for (size_t i = 0; i < own.picture.channel_count && tile->begins; i++)
            memcpy(r->result->planes[i] + to, own.planes[i] + from, (size_t)width * sizeof(float));
    }
    tiles_free(&own);
    return status;
}

/* Reads the samples of a file, if it is still what it was when its header was read. */
static KrsStatus read_again(Reading *r, Tile *tile)
{
    Tile      again  = {.path = tile->path};
    KrsStatus status = open_tile(&again);
    if (status != KRS_OK)
        return status;
    status = read_header(r->options, &again);
    if (status == KRS_OK)
        status = check_alike(&r->tiles[0], &again);
    if (status == KRS_OK && memcmp(&again.data, &tile->data, sizeof again.data) != 0)
        status = say_unusable(tile->path, "it is written to meanwhile");
    again.begins = tile->begins;
    r->now       = &again;
    if (status == KRS_OK)
        status = again.range.divided ? add_range(r) : read_samples(r);
    exr_finish(&again.context);
    return status;
}

KrsStatus tiles_read(const Options *options, const char *const *paths, size_t count, Tiles *tiles)
{
    Reading   r      = {.options = options, .count = count, .result = tiles};
    KrsStatus status = KRS_OK;
    *tiles           = (Tiles){.planes = NULL};
    r.tiles          = arena_new_array(options->arena, Tile, count);
    for (size_t i = 0; i < count && status == KRS_OK; i++) {
        r.tiles[i] = (Tile){.path = paths[i]};
        status     = open_tile(&r.tiles[i]);
        if (status != KRS_OK)
            break;
        status = read_header(options, &r.tiles[i]);
        exr_finish(&r.tiles[i].context);
    }
    qsort(r.tiles, status == KRS_OK ? count : 0, sizeof *r.tiles, by_place);
    if (status == KRS_OK)
        status = read_tiles(&r);
    for (size_t i = 0; i < count && status == KRS_OK; i++)
        status = read_again(&r, &r.tiles[i]);
    if (status == KRS_OK && r.tiles[0].range.divided)
        finish_ranges(&r);
    ranges_free(&r.sums);
    if (status != KRS_OK)
        tiles_free(tiles);
    return status;
}

static bool fill(const void *user, OutputFile *file, OutputError *error)
{
    return exr_write(user, file, error);
}

KrsStatus tiles_write(const Tiles *tiles, const char *path)
{
    return write_output(path, fill, &tiles->picture);
}

void tiles_free(Tiles *tiles)
{
    for (size_t i = 0; tiles->planes && i < tiles->picture.channel_count; i++)
        free(tiles->planes[i]);
    *tiles = (Tiles){.planes = NULL};
}
