/*
 * picture.h: the input of the writers of image files: planes of samples, and texts about them.
 */
#ifndef KRS_WRITER_PICTURE_H
#define KRS_WRITER_PICTURE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "runtime/writer/atomic.h"

/* The type of the samples of a channel in the file.  In memory a half is a float, and is rounded
   when it is written. */
typedef enum SampleType { SAMPLE_HALF, SAMPLE_FLOAT, SAMPLE_UINT } SampleType;

typedef struct PictureChannel {
    const char *name; /* "R", "albedo.G", "id.component" */
    SampleType  type;
    const void *samples; /* float, or uint32_t for SAMPLE_UINT; row 0 is the top */
    size_t      stride;  /* samples from one pixel to the next: 4 for interleaved RGBA */
} PictureChannel;

/* A text that is stored in the file, such as "krs:scene", "9c0ffee...". */
typedef struct PictureText {
    const char *name, *value;
} PictureText;

/* Imath's convention: points are row vectors, p' = p M, so m[3] is the translation. */
typedef struct PictureMatrix {
    float m[4][4];
} PictureMatrix;

typedef struct Picture {
    uint32_t              width, height;           /* of the whole picture: EXR's displayWindow */
    uint32_t              crop_x, crop_y;          /* the part that is stored: EXR's dataWindow */
    uint32_t              crop_width, crop_height; /* the size of every channel */
    const PictureChannel *channels;
    size_t                channel_count;
    const PictureText    *texts;
    size_t                text_count;
    const PictureMatrix  *world_to_camera, *world_to_ndc; /* NULL: not written */
} Picture;

#endif
