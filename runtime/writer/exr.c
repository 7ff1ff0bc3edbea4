/*
 * exr.c: writes OpenEXR files with OpenEXRCore, the C library underneath OpenEXR.
 *
 * The library neither flushes its own files to the disk nor removes them after an error.  So a
 * callback passes the bytes to an OutputFile, which does both.  A chunk is 16 lines.  The library
 * wants packed samples, so the lines of a chunk are first copied to a block per channel, where
 * floats become halves.
 *
 * Packing and compressing take nearly all of the time, so several threads share the chunks.  Each
 * waits for its turn to write, so the file is the same as that of one thread.
 */
#include "runtime/writer/exr.h"

#include <OpenEXR/openexr.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "compiler/base/half.h"
#include "compiler/base/parallel.h"
#include "runtime/writer/exr_zip.h"

enum {
    /* The threads at most: only one writes at any time, and each needs memory for a chunk. */
    MAX_WORKERS = 8
};

typedef struct ExrWriter {
    const Picture      *picture;
    exr_const_context_t like; /* a file whose attributes are taken; NULL: none */
    exr_attr_box2i_t    display, data;
    OutputFile         *file;
    OutputError        *error;
    exr_context_t       context;
} ExrWriter;

/* The chunks of a picture.  Threads take them from the top on, under the lock, and write them in
   that order. */
typedef struct Chunks {
    ExrWriter      *writer;
    uint32_t        lines, count; /* lines of a chunk; the number of chunks */
    pthread_mutex_t lock;
    pthread_cond_t  next; /* a chunk was written, or something failed */
    uint32_t        taken, written;
    exr_result_t    result; /* the first failure; no chunk is taken after it */
} Chunks;

typedef struct Worker {
    Chunks               *chunks;
    pthread_t             thread;
    uint32_t              chunk;    /* number of the chunk that it has taken */
    uint32_t             *block;    /* packed lines of all channels, in the picture's order */
    bool                  begun;    /* the pipeline is set up */
    exr_encode_pipeline_t pipeline; /* keeps its buffers from chunk to chunk, */
    ExrZip                zip;      /* but for these */
} Worker;

static int64_t write_callback(exr_const_context_t context, void *user, const void *bytes,
                              uint64_t length, uint64_t offset, exr_stream_error_func_ptr_t fail)
{
    ExrWriter *writer = user;
    if (output_write(writer->file, bytes, length, offset))
        return (int64_t)length;
    fail(context, EXR_ERR_WRITE_IO, "%s", writer->error->message);
    return -1;
}

/* Ignores messages: the library also reports errors by results, and would print them as well
   without this handler. */
static void ignore_message(exr_const_context_t context, exr_result_t code, const char *message)
{
    (void)context, (void)code, (void)message;
}

/* Turns a result of the library into an error, unless a failed write has already reported its own
   reason. */
static bool exr_try(ExrWriter *writer, exr_result_t result)
{
    if (result == EXR_ERR_SUCCESS)
        return true;
    if (writer->error->status == KRS_OK) {
        writer->error->status = result == EXR_ERR_OUT_OF_MEMORY ? KRS_OUT_OF_MEMORY : KRS_INTERNAL;
        snprintf(writer->error->message, sizeof writer->error->message,
                 "cannot make an EXR file: %s", exr_get_default_error_message(result));
    }
    return false;
}

static void find_windows(ExrWriter *writer)
{
    const Picture *picture = writer->picture;
    writer->display        = (exr_attr_box2i_t){
               .max = {.x = (int32_t)picture->width - 1, .y = (int32_t)picture->height - 1}};
    writer->data = (exr_attr_box2i_t){
        .min = {.x = (int32_t)picture->crop_x, .y = (int32_t)picture->crop_y},
        .max = {.x = (int32_t)(picture->crop_x + picture->crop_width) - 1,
                .y = (int32_t)(picture->crop_y + picture->crop_height) - 1}};
    if (writer->like) {
        exr_get_display_window(writer->like, 0, &writer->display);
        exr_get_data_window(writer->like, 0, &writer->data);
    }
}

static bool write_layout(ExrWriter *writer)
{
    const Picture *picture = writer->picture;
    exr_attr_v2f_t center  = {.x = 0, .y = 0};
    int            part;
    if (!exr_try(writer, exr_add_part(writer->context, "krs", EXR_STORAGE_SCANLINE, &part)) ||
        !exr_try(writer, exr_initialize_required_attr(
                             writer->context, 0, &writer->display, &writer->data, 1, &center, 1,
                             EXR_LINEORDER_INCREASING_Y, EXR_COMPRESSION_ZIP)))
        return false;

    static const exr_pixel_type_t types[] = {[SAMPLE_HALF]  = EXR_PIXEL_HALF,
                                             [SAMPLE_FLOAT] = EXR_PIXEL_FLOAT,
                                             [SAMPLE_UINT]  = EXR_PIXEL_UINT};
    for (size_t i = 0; i < picture->channel_count; i++)
        if (!exr_try(writer, exr_add_channel(writer->context, 0, picture->channels[i].name,
                                             types[picture->channels[i].type],
                                             EXR_PERCEPTUALLY_LOGARITHMIC, 1, 1)))
            return false;
    return true;
}

static bool write_matrix(ExrWriter *writer, const char *name, const PictureMatrix *matrix)
{
    exr_attr_m44f_t attribute;
    if (!matrix)
        return true;
    memcpy(attribute.m, matrix->m, sizeof attribute.m); /* both are stored row by row */
    return exr_try(writer, exr_attr_set_m44f(writer->context, 0, name, &attribute));
}

static exr_result_t copy_attribute(exr_context_t to, const exr_attribute_t *a)
{
    switch (a->type) {
    case EXR_ATTR_BOX2I: return exr_attr_set_box2i(to, 0, a->name, a->box2i);
    case EXR_ATTR_BOX2F: return exr_attr_set_box2f(to, 0, a->name, a->box2f);
    case EXR_ATTR_CHROMATICITIES:
        return exr_attr_set_chromaticities(to, 0, a->name, a->chromaticities);
    case EXR_ATTR_DOUBLE: return exr_attr_set_double(to, 0, a->name, a->d);
    case EXR_ATTR_FLOAT: return exr_attr_set_float(to, 0, a->name, a->f);
    case EXR_ATTR_INT: return exr_attr_set_int(to, 0, a->name, a->i);
    case EXR_ATTR_KEYCODE: return exr_attr_set_keycode(to, 0, a->name, a->keycode);
    case EXR_ATTR_M33F: return exr_attr_set_m33f(to, 0, a->name, a->m33f);
    case EXR_ATTR_M44F: return exr_attr_set_m44f(to, 0, a->name, a->m44f);
    case EXR_ATTR_RATIONAL: return exr_attr_set_rational(to, 0, a->name, a->rational);
    case EXR_ATTR_STRING: return exr_attr_set_string(to, 0, a->name, a->string->str);
    case EXR_ATTR_TIMECODE: return exr_attr_set_timecode(to, 0, a->name, a->timecode);
    case EXR_ATTR_V2I: return exr_attr_set_v2i(to, 0, a->name, a->v2i);
    case EXR_ATTR_V2F: return exr_attr_set_v2f(to, 0, a->name, a->v2f);
    case EXR_ATTR_V3I: return exr_attr_set_v3i(to, 0, a->name, a->v3i);
    case EXR_ATTR_V3F: return exr_attr_set_v3f(to, 0, a->name, a->v3f);
    default: return EXR_ERR_SUCCESS; /* of the other file's form, or known to few */
    }
}

/* Copies what another file says but for its form, which is that of all files here. */
static bool copy_attributes(ExrWriter *writer)
{
    static const char *const own[] = {"name",       "type",       "version",
                                      "chunkCount", "dataWindow", "displayWindow"};
    int32_t                  count = 0;
    bool good = exr_try(writer, exr_get_attribute_count(writer->like, 0, &count));
    for (int32_t i = 0; i < count && good; i++) {
        const exr_attribute_t *attribute;
        bool                   copied = true;
        good = exr_try(writer, exr_get_attribute_by_index(writer->like, 0, EXR_ATTR_LIST_FILE_ORDER,
                                                          i, &attribute));
        for (size_t k = 0; k < sizeof own / sizeof *own && good; k++)
            copied = copied && strcmp(attribute->name, own[k]) != 0;
        if (good && copied)
            good = exr_try(writer, copy_attribute(writer->context, attribute));
    }
    return good;
}

static bool write_attributes(ExrWriter *writer)
{
    const Picture                  *picture = writer->picture;
    const exr_attr_chromaticities_t rec709  = {.red_x   = 0.64f,
                                               .red_y   = 0.33f,
                                               .green_x = 0.3f,
                                               .green_y = 0.6f,
                                               .blue_x  = 0.15f,
                                               .blue_y  = 0.06f,
                                               .white_x = 0.3127f,
                                               .white_y = 0.329f};
    if (writer->like)
        return copy_attributes(writer);
    if (!exr_try(writer,
                 exr_attr_set_chromaticities(writer->context, 0, "chromaticities", &rec709)) ||
        !write_matrix(writer, "worldToCamera", picture->world_to_camera) ||
        !write_matrix(writer, "worldToNDC", picture->world_to_ndc))
        return false;
    for (size_t i = 0; i < picture->text_count; i++)
        if (!exr_try(writer, exr_attr_set_string(writer->context, 0, picture->texts[i].name,
                                                 picture->texts[i].value)))
            return false;
    return true;
}

/* Packs lines [first, first + count) of a channel as the file has them. */
static void pack_lines(const Picture *picture, const PictureChannel *channel, size_t first,
                       size_t count, void *block)
{
    size_t samples = count * picture->crop_width;
    size_t start   = first * picture->crop_width;
    if (channel->type == SAMPLE_UINT) {
        const uint32_t *source = (const uint32_t *)channel->samples + start * channel->stride;
        uint32_t       *target = block;
        for (size_t i = 0; i < samples; i++)
            target[i] = source[i * channel->stride];
        return;
    }
    const float *source = (const float *)channel->samples + start * channel->stride;
    if (channel->type == SAMPLE_HALF) {
        uint16_t *target = block;
        for (size_t i = 0; i < samples; i++)
            target[i] = half_from_float(source[i * channel->stride]);
    } else {
        float *target = block;
        for (size_t i = 0; i < samples; i++)
            target[i] = source[i * channel->stride];
    }
}

/* Packs the lines of a chunk.  The library sorts channels by name, so they are matched by name. */
static void pack_chunk(Worker *worker)
{
    const Picture         *picture  = worker->chunks->writer->picture;
    exr_encode_pipeline_t *pipeline = &worker->pipeline;
    size_t first = (size_t)(pipeline->chunk.start_y - worker->chunks->writer->data.min.y);
    for (int c = 0; c < pipeline->channel_count; c++) {
        exr_coding_channel_info_t *target = &pipeline->channels[c];
        size_t                     i      = 0;
        while (strcmp(picture->channels[i].name, target->channel_name) != 0)
            i++;
        void *packed = worker->block + i * worker->chunks->lines * picture->crop_width;
        pack_lines(picture, &picture->channels[i], first, (size_t)target->height, packed);
        target->encode_from_ptr        = packed;
        target->user_bytes_per_element = target->bytes_per_element;
        target->user_data_type         = target->data_type;
        target->user_pixel_stride      = target->bytes_per_element;
        target->user_line_stride       = target->bytes_per_element * target->width;
    }
}

/* Waits for its place in the order, before the library writes what a worker has encoded. */
static exr_result_t wait_for_turn(exr_encode_pipeline_t *pipeline)
{
    const Worker *worker = pipeline->encoding_user_data;
    Chunks       *chunks = worker->chunks;
    pthread_mutex_lock(&chunks->lock);
    while (chunks->written != worker->chunk && chunks->result == EXR_ERR_SUCCESS)
        pthread_cond_wait(&chunks->next, &chunks->lock);
    exr_result_t result = chunks->result;
    pthread_mutex_unlock(&chunks->lock);
    return result;
}

static exr_result_t compress(exr_encode_pipeline_t *pipeline)
{
    Worker *worker = pipeline->encoding_user_data;
    return exr_zip(&worker->zip, pipeline);
}

/* Takes the next chunk; false when there is none. */
static bool take_chunk(Worker *worker)
{
    Chunks *chunks = worker->chunks;
    pthread_mutex_lock(&chunks->lock);
    bool taken = chunks->taken < chunks->count && chunks->result == EXR_ERR_SUCCESS;
    if (taken)
        worker->chunk = chunks->taken++;
    pthread_mutex_unlock(&chunks->lock);
    return taken;
}

static exr_result_t write_chunk(Worker *worker)
{
    const Chunks          *chunks   = worker->chunks;
    exr_context_t          context  = chunks->writer->context;
    exr_encode_pipeline_t *pipeline = &worker->pipeline;
    const int              y = chunks->writer->data.min.y + (int)(worker->chunk * chunks->lines);
    exr_chunk_info_t       info;
    exr_result_t           result = exr_write_scanline_chunk_info(context, 0, y, &info);
    if (result != EXR_ERR_SUCCESS)
        return result;
    result = worker->begun ? exr_encoding_update(context, 0, &info, pipeline)
                           : exr_encoding_initialize(context, 0, &info, pipeline);
    if (result != EXR_ERR_SUCCESS)
        return result;
    pack_chunk(worker);
    if (!worker->begun) {
        worker->begun = true;
        result        = exr_encoding_choose_default_routines(context, 0, pipeline);
        if (result != EXR_ERR_SUCCESS)
            return result;
        pipeline->encoding_user_data   = worker;
        pipeline->compress_fn          = compress;
        pipeline->yield_until_ready_fn = wait_for_turn;
    }
    return exr_encoding_run(context, 0, pipeline);
}

static void *work(void *user)
{
    Worker *worker = user;
    Chunks *chunks = worker->chunks;
    while (take_chunk(worker)) {
        exr_result_t result = write_chunk(worker);
        pthread_mutex_lock(&chunks->lock);
        if (result == EXR_ERR_SUCCESS)
            chunks->written++;
        else if (chunks->result == EXR_ERR_SUCCESS)
            chunks->result = result;
        pthread_cond_broadcast(&chunks->next);
        pthread_mutex_unlock(&chunks->lock);
    }
    return NULL;
}

/* Returns the number of threads: as many as processors that this process may use, at most one for a
   chunk. */
static uint32_t count_workers(const Chunks *chunks)
{
    const uint32_t parts = (uint32_t)parallel_parts();
    const uint32_t count = parts < MAX_WORKERS ? parts : MAX_WORKERS;
    return count < chunks->count ? count : chunks->count;
}

/* Runs the threads, of which the calling one is the first.  It works alone where no other can be
   created. */
static void run_workers(Chunks *chunks)
{
    const Picture *picture = chunks->writer->picture;
    Worker         workers[MAX_WORKERS];
    uint32_t       count = 0, wanted = count_workers(chunks);
    size_t         samples = picture->channel_count * chunks->lines * picture->crop_width;
    for (; count < wanted; count++) {
        Worker *worker = &workers[count];
        *worker        = (Worker){.chunks = chunks, .pipeline = EXR_ENCODE_PIPELINE_INITIALIZER};
        worker->block  = malloc(samples * sizeof *worker->block);
        if (!worker->block)
            break;
        if (count > 0 && pthread_create(&worker->thread, NULL, work, worker) != 0) {
            free(worker->block);
            break;
        }
    }
    if (count == 0)
        chunks->result = EXR_ERR_OUT_OF_MEMORY;
    else
        work(&workers[0]);
    for (uint32_t i = 0; i < count; i++) {
        if (i > 0)
            pthread_join(workers[i].thread, NULL);
        exr_zip_end(&workers[i].zip, &workers[i].pipeline);
        exr_encoding_destroy(chunks->writer->context, &workers[i].pipeline);
        free(workers[i].block);
    }
}

static bool write_chunks(ExrWriter *writer)
{
    int32_t lines;
    if (!exr_try(writer, exr_get_scanlines_per_chunk(writer->context, 0, &lines)))
        return false;
    Chunks chunks = {.writer = writer,
                     .lines  = (uint32_t)lines,
                     .result = EXR_ERR_SUCCESS,
                     .count  = (writer->picture->crop_height + (uint32_t)lines - 1) /
                              (uint32_t)lines,
                     .lock = PTHREAD_MUTEX_INITIALIZER,
                     .next = PTHREAD_COND_INITIALIZER};
    run_workers(&chunks);
    pthread_cond_destroy(&chunks.next);
    pthread_mutex_destroy(&chunks.lock);
    return exr_try(writer, chunks.result);
}

bool exr_write(const Picture *picture, OutputFile *file, OutputError *error)
{
    return exr_write_like(picture, NULL, file, error);
}

bool exr_write_like(const Picture *picture, exr_const_context_t like, OutputFile *file,
                    OutputError *error)
{
    ExrWriter writer = {.picture = picture, .like = like, .file = file, .error = error};
    exr_context_initializer_t setup = EXR_DEFAULT_CONTEXT_INITIALIZER;
    setup.error_handler_fn          = ignore_message;
    setup.user_data                 = &writer;
    setup.write_fn                  = write_callback;

    find_windows(&writer);
    bool done = exr_try(
        &writer, exr_start_write(&writer.context, "picture", EXR_WRITE_FILE_DIRECTLY, &setup));
    if (done) {
        done = write_layout(&writer) && write_attributes(&writer) &&
               exr_try(&writer, exr_write_header(writer.context)) && write_chunks(&writer);
        exr_result_t finished = exr_finish(&writer.context); /* writes the table of chunks */
        done                  = done && exr_try(&writer, finished);
    }
    return done;
}
