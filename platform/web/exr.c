/*
 * exr.c: a page reads no OpenEXR files: their decoders are as large as the compiler.
 */
#include "compiler/image/image.h"

bool image_read_exr(Image *image, const unsigned char *bytes, size_t length)
{
    (void)bytes, (void)length;
    return image_fail(image, "pages read PNG files, and none of OpenEXR");
}
