/*
 * tiles.c: EXR files of `krs render` that are parts of one picture, as one picture.
 *
 * What the writer of pictures was given is read back: samples as they are stored, texts in their order, matrices.  So
 * it writes the same bytes as for a picture that was rendered at once.
 */
#include "cli/farm/tiles.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "cli/shell/console.h"
#include "compiler/base/exr_chunks.h"

static const char *const matrix_names[2] = {"worldToCamera", "worldToNDC"};

/* A file of them. */
typedef struct Tile {
    const char      *path;
    exr_context_t    context;
    exr_attr_box2i_t data, display;
    Tiles            header; /* without samples */
} Tile;

typedef struct Reading {
    const Options   *options;
    Tile            *tiles;
    size_t           count;
    exr_attr_box2i_t whole; /* what they have together */
    Tiles           *result;
    const Tile      *now; /* whose samples are read */
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
    return KRS_OK;
}

/* ---- whether they are of one picture ---- */

/* Tells whether a text names what is seen in a part: a manifest of Cryptomatte. */
static bool is_manifest(const char *name)
{
    const char *slash = strrchr(name, '/');
    return strncmp(name, "cryptomatte/", 12) == 0 && slash && strcmp(slash, "/manifest") == 0;
}

static bool same_texts(const Tiles *a, const Tiles *b, const char **different)
{
    *different = NULL;
    if (a->picture.text_count != b->picture.text_count)
        return false;
    for (size_t i = 0; i < a->picture.text_count; i++)
        if (strcmp(a->texts[i].name, b->texts[i].name) != 0 ||
            (!is_manifest(a->texts[i].name) && strcmp(a->texts[i].value, b->texts[i].value) != 0)) {
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
    if (!same_channels(&a->header, &b->header))
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
        pixels += area(data);
        for (size_t k = 0; k < i; k++)
            if (overlap(data, &r->tiles[k].data)) {
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

/* Says that the lines of a chunk go to their place in the planes. */
static void place_lines(void *user, exr_decode_pipeline_t *pipeline)
{
    const Reading *r     = user;
    const size_t   width = r->result->picture.crop_width;
    const size_t   row   = (size_t)(pipeline->chunk.start_y - r->whole.min.y);
    const size_t   first = row * width + (size_t)(r->now->data.min.x - r->whole.min.x);
    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *channel = &pipeline->channels[c];
        size_t                     i       = 0;
        while (strcmp(r->result->channels[i].name, channel->channel_name) != 0)
            i++;
        channel->decode_to_ptr          = (uint8_t *)(r->result->planes[i] + first);
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

/* Makes the picture of all files, as that of the first. */
static KrsStatus make_picture(Reading *r)
{
    Tiles   *tiles           = r->result;
    Picture *picture         = &tiles->picture;
    *tiles                   = r->tiles[0].header;
    tiles->planes            = arena_new_array(r->options->arena, float *, picture->channel_count);
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
    for (size_t i = 0; i < picture->channel_count; i++)
        tiles->planes[i] = NULL;
    for (size_t i = 0; i < picture->channel_count; i++) {
        tiles->planes[i] = malloc(area(&r->whole) * sizeof(float));
        if (!tiles->planes[i])
            return say_status(KRS_OUT_OF_MEMORY, r->tiles[0].path);
        tiles->channels[i].samples = tiles->planes[i];
    }
    return KRS_OK;
}

static KrsStatus read_tiles(Reading *r)
{
    KrsStatus status = KRS_OK;
    for (size_t i = 1; i < r->count && status == KRS_OK; i++)
        status = check_alike(&r->tiles[0], &r->tiles[i]);
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
    r->now = &again;
    if (status == KRS_OK)
        status = read_samples(r);
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
    if (status == KRS_OK)
        status = read_tiles(&r);
    for (size_t i = 0; i < count && status == KRS_OK; i++)
        status = read_again(&r, &r.tiles[i]);
    if (status != KRS_OK)
        tiles_free(tiles);
    return status;
}

void tiles_free(Tiles *tiles)
{
    for (size_t i = 0; tiles->planes && i < tiles->picture.channel_count; i++)
        free(tiles->planes[i]);
    *tiles = (Tiles){.planes = NULL};
}
