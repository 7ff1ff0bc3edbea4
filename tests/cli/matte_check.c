/*
 * matte_check.c: reads an EXR as a compositor reads Cryptomatte 1.2, and checks the promises of the
 * specification; it shares nothing with the writer.  For each layer it prints, per name of the
 * manifest, the number of pixels that it covers: `layer name pixels`.  For the tests.
 */
#include <OpenEXR/openexr.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { CHANNELS = 96, NAMES = 4096 };

static void fail(const char *what)
{
    fprintf(stderr, "matte_check: %s\n", what);
    exit(1);
}

static void must(exr_result_t result)
{
    if (result != EXR_ERR_SUCCESS)
        fail(exr_get_error_code_as_string(result));
}

/* MurmurHash3_x86_32 of Austin Appleby, whose code is in the public domain, as he has it. */
static uint32_t murmur(const char *key, size_t length)
{
    const uint32_t c1 = 0xcc9e2d51, c2 = 0x1b873593;
    uint32_t       h1 = 0, k1 = 0;
    for (size_t i = 0; i < length / 4; i++) {
        memcpy(&k1, key + 4 * i, 4);
        k1 *= c1;
        k1 = (k1 << 15) | (k1 >> 17);
        k1 *= c2;
        h1 ^= k1;
        h1 = (h1 << 13) | (h1 >> 19);
        h1 = h1 * 5 + 0xe6546b64;
    }
    const unsigned char *tail = (const unsigned char *)key + length / 4 * 4;
    k1                        = 0;
    switch (length & 3) {
    case 3: k1 ^= (uint32_t)tail[2] << 16; /* fall through */
    case 2: k1 ^= (uint32_t)tail[1] << 8;  /* fall through */
    case 1:
        k1 ^= tail[0];
        k1 *= c1;
        k1 = (k1 << 15) | (k1 >> 17);
        k1 *= c2;
        h1 ^= k1;
    }
    h1 ^= (uint32_t)length;
    h1 ^= h1 >> 16;
    h1 *= 0x85ebca6b;
    h1 ^= h1 >> 13;
    h1 *= 0xc2b2ae35;
    h1 ^= h1 >> 16;
    return h1;
}

static void check_hash(void)
{
    static const struct {
        const char *text;
        uint32_t    hash;
    } known[] = {{"", 0},
                 {"hello", 0x248bfa47},
                 {"hello, world", 0x149bbb7f},
                 {"The quick brown fox jumps over the lazy dog", 0x2e4ff723}};
    for (size_t i = 0; i < sizeof known / sizeof known[0]; i++)
        if (murmur(known[i].text, strlen(known[i].text)) != known[i].hash)
            fail("its own hash is wrong");
}

/* ---- the file ---- */

typedef struct Image {
    exr_context_t context;
    int           width, height, count;
    char          names[CHANNELS][64];
    float        *values[CHANNELS];
} Image;

static void read_pixels(Image *image)
{
    exr_attr_box2i_t      window;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    int32_t               lines;
    must(exr_get_data_window(image->context, 0, &window));
    must(exr_get_scanlines_per_chunk(image->context, 0, &lines));
    image->width  = window.max.x - window.min.x + 1;
    image->height = window.max.y - window.min.y + 1;
    for (int y = 0; y < image->height; y += lines) {
        exr_chunk_info_t chunk;
        must(exr_read_scanline_chunk_info(image->context, 0, window.min.y + y, &chunk));
        must(y == 0 ? exr_decoding_initialize(image->context, 0, &chunk, &pipeline)
                    : exr_decoding_update(image->context, 0, &chunk, &pipeline));
        image->count = pipeline.channel_count;
        for (int c = 0; c < image->count; c++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[c];
            if (!image->values[c])
                image->values[c] = calloc((size_t)(image->width * (image->height + lines)), 4);
            snprintf(image->names[c], sizeof image->names[c], "%s", channel->channel_name);
            channel->decode_to_ptr          = (uint8_t *)(image->values[c] + y * image->width);
            channel->user_bytes_per_element = 4;
            channel->user_data_type         = channel->data_type == EXR_PIXEL_UINT ? EXR_PIXEL_UINT
                                                                                   : EXR_PIXEL_FLOAT;
            channel->user_pixel_stride      = 4;
            channel->user_line_stride       = 4 * image->width;
        }
        if (y == 0)
            must(exr_decoding_choose_default_routines(image->context, 0, &pipeline));
        must(exr_decoding_run(image->context, 0, &pipeline));
    }
    must(exr_decoding_destroy(image->context, &pipeline));
}

static const float *find_channel(const Image *image, const char *layer, int number, char letter)
{
    char name[96];
    snprintf(name, sizeof name, letter ? "%s%02d.%c" : "%s", layer, number, letter);
    for (int c = 0; c < image->count; c++)
        if (strcmp(image->names[c], name) == 0)
            return image->values[c];
    return NULL;
}

static const char *find_text(const Image *image, const char *key, const char *member)
{
    char        name[64];
    const char *text = NULL;
    int32_t     length;
    snprintf(name, sizeof name, "cryptomatte/%s/%s", key, member);
    must(exr_attr_get_string(image->context, 0, name, &length, &text));
    return text;
}

/* ---- a layer ---- */

typedef struct Manifest {
    char     names[NAMES][128];
    uint32_t identifiers[NAMES];
    double   covered[NAMES];
    int      count;
} Manifest;

/* Reads {"name": "hex", ...}; the names of the tests have no escapes. */
static void read_manifest(const char *text, Manifest *manifest)
{
    int used        = 0;
    manifest->count = 0;
    if (*text++ != '{')
        fail("a manifest is no object");
    while (sscanf(text, " \"%127[^\"]\" : \"%8x\"%n", manifest->names[manifest->count],
                  &manifest->identifiers[manifest->count], &used) == 2) {
        const char *name = manifest->names[manifest->count];
        uint32_t    hash = murmur(name, strlen(name));
        float       number;
        if ((hash >> 23 & 255) == 0 || (hash >> 23 & 255) == 255)
            hash ^= 1u << 23;
        memcpy(&number, &hash, 4);
        if (manifest->identifiers[manifest->count] != hash || !isnormal(number))
            fail("an identifier is not the hash of its name");
        manifest->covered[manifest->count++] = 0;
        text += used;
        text += *text == ',';
    }
    if (*text != '}')
        fail("a manifest does not end");
}

static int find_identifier(const Manifest *manifest, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, 4);
    for (int i = 0; i < manifest->count; i++)
        if (manifest->identifiers[i] == bits)
            return i;
    fail("a pixel has an identifier that is not in the manifest");
    return -1;
}

static void check_layer(const Image *image, const char *key)
{
    static Manifest manifest;
    const char     *layer = find_text(image, key, "name");
    char            wanted[9];
    const float    *alpha  = find_channel(image, "A", 0, 0);
    const size_t    pixels = (size_t)(image->width * image->height);
    snprintf(wanted, sizeof wanted, "%08x", murmur(layer, strlen(layer)));
    if (strncmp(wanted, key, 7) != 0 || strlen(key) != 7)
        fail("the key is not the hash of the layer's name");
    if (strcmp(find_text(image, key, "hash"), "MurmurHash3_32") != 0 ||
        strcmp(find_text(image, key, "conversion"), "uint32_to_float32") != 0)
        fail("hash or conversion is unknown");
    read_manifest(find_text(image, key, "manifest"), &manifest);
    for (size_t k = 0; k < pixels; k++) {
        double sum = 0, before = 1;
        for (int rank = 0;; rank++) {
            const float *id    = find_channel(image, layer, rank / 2, "RB"[rank % 2]);
            const float *share = find_channel(image, layer, rank / 2, "GA"[rank % 2]);
            if (!id || !share)
                break;
            if (share[k] > 0)
                manifest.covered[find_identifier(&manifest, id[k])] += (double)share[k];
            if ((double)share[k] > before)
                fail("ranks are not sorted");
            before = (double)share[k];
            sum += before;
        }
        if (fabs(sum - (double)alpha[k]) > 2e-3) /* alpha is a half */
            fail("shares do not add up to alpha");
    }
    for (int i = 0; i < manifest.count; i++)
        printf("%s %s %.4f\n", layer, manifest.names[i], manifest.covered[i]);
}

int main(int argc, char **argv)
{
    static Image image;
    int32_t      count;
    bool         found = false;
    check_hash();
    if (argc < 2)
        return 2;
    must(exr_start_read(&image.context, argv[1], NULL));
    read_pixels(&image);
    must(exr_get_attribute_count(image.context, 0, &count));
    for (int32_t i = 0; i < count; i++) {
        const exr_attribute_t *attribute;
        char                   key[8];
        int                    end = 0;
        must(exr_get_attribute_by_index(image.context, 0, EXR_ATTR_LIST_FILE_ORDER, i, &attribute));
        if (sscanf(attribute->name, "cryptomatte/%7[0-9a-f]/name%n", key, &end) == 1 && end > 0) {
            check_layer(&image, key);
            found = true;
        }
    }
    return found ? 0 : 1;
}
