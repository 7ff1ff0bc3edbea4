/*
 * exr_text.c: prints the pixels of an EXR file, one line each: `channel x y value`, x and y
 * counted in the display window.  With a second argument, that channel only.  For the tests.
 */
#include <OpenEXR/openexr.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void must(exr_result_t result)
{
    if (result == EXR_ERR_SUCCESS)
        return;
    fprintf(stderr, "exr_text: %s\n", exr_get_error_code_as_string(result));
    exit(1);
}

/* Halves and floats are both read as float. */
static void print_line(const exr_coding_channel_info_t *channel, const uint8_t *samples, int x0,
                       int y)
{
    for (int x = 0; x < channel->width; x++) {
        const uint8_t *sample = samples + 4 * (size_t)x;
        printf("%s %d %d ", channel->channel_name, x0 + x, y);
        if (channel->data_type == EXR_PIXEL_UINT) {
            uint32_t value;
            memcpy(&value, sample, sizeof value);
            printf("%u\n", value);
        } else {
            float value;
            memcpy(&value, sample, sizeof value);
            printf("%.9g\n", value);
        }
    }
}

static void print_chunk(exr_decode_pipeline_t *pipeline, const char *only, uint8_t *const *buffers,
                        int x0)
{
    for (int c = 0; c < pipeline->channel_count; c++) {
        const exr_coding_channel_info_t *channel = &pipeline->channels[c];
        if (only && strcmp(only, channel->channel_name) != 0)
            continue;
        for (int line = 0; line < channel->height; line++)
            print_line(channel, buffers[c] + (size_t)line * 4 * (size_t)channel->width, x0,
                       pipeline->chunk.start_y + line);
    }
}

int main(int argc, char **argv)
{
    enum { CHANNELS = 64 };
    exr_context_t         context;
    exr_attr_box2i_t      window;
    exr_decode_pipeline_t pipeline = EXR_DECODE_PIPELINE_INITIALIZER;
    uint8_t              *buffers[CHANNELS];
    int32_t               lines;
    if (argc < 2)
        return 2;
    must(exr_start_read(&context, argv[1], NULL));
    must(exr_get_data_window(context, 0, &window));
    must(exr_get_scanlines_per_chunk(context, 0, &lines));
    size_t width = (size_t)(window.max.x - window.min.x) + 1;
    for (int c = 0; c < CHANNELS; c++)
        if (!(buffers[c] = malloc(width * (size_t)lines * 4)))
            return 1;
    for (int y = window.min.y; y <= window.max.y; y += lines) {
        exr_chunk_info_t chunk;
        must(exr_read_scanline_chunk_info(context, 0, y, &chunk));
        must(y == window.min.y ? exr_decoding_initialize(context, 0, &chunk, &pipeline)
                               : exr_decoding_update(context, 0, &chunk, &pipeline));
        for (int c = 0; c < pipeline.channel_count; c++) {
            exr_coding_channel_info_t *channel = &pipeline.channels[c];
            bool                       integer = channel->data_type == EXR_PIXEL_UINT;
            channel->decode_to_ptr             = buffers[c];
            channel->user_bytes_per_element    = 4;
            channel->user_data_type            = integer ? EXR_PIXEL_UINT : EXR_PIXEL_FLOAT;
            channel->user_pixel_stride         = 4;
            channel->user_line_stride          = 4 * channel->width;
        }
        if (y == window.min.y)
            must(exr_decoding_choose_default_routines(context, 0, &pipeline));
        must(exr_decoding_run(context, 0, &pipeline));
        print_chunk(&pipeline, argc > 2 ? argv[2] : NULL, buffers, window.min.x);
    }
    exr_decoding_destroy(context, &pipeline);
    exr_finish(&context);
    for (int c = 0; c < CHANNELS; c++)
        free(buffers[c]);
    return 0;
}
