/*
 * saving.c: what the viewer saves, and under which names.
 */
#include "live/saving.h"

#include <png.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

#include "runtime/writer/atomic.h"

/* Chooses the first name of a kind that is free, without its ending. */
static void choose_name(const char *kind, const char *ending, char name[200])
{
    char path[260];
    int  number = 0;
    do {
        snprintf(name, 200, "%s-%04d", kind, number++);
        snprintf(path, sizeof path, "%s%s", name, ending);
    } while (access(path, F_OK) == 0 && number < 10000);
}

/* Writes what is seen as every output is written: whole, and through no link where those are forbidden.  False: error->message
   has the reason, or is empty where memory has run out. */
static bool write_png(png_image *image, const uint8_t *pixels, const char *path, OutputError *error)
{
    png_alloc_size_t size    = PNG_IMAGE_PNG_SIZE_MAX(*image);
    char            *text    = malloc(size);
    const bool       written = text &&
                         png_image_write_to_memory(image, text, &size, 0, pixels, 0, NULL) &&
                         output_text(path, text, size, NULL, error) == KRS_OK;
    free(text);
    return written;
}

void saving_keep_shot(Viewing *viewing)
{
    const Shot *shot = &viewing->shot;
    char        name[200], path[260];
    OutputError error = {0};
    png_image   image = {.version = PNG_IMAGE_VERSION,
                         .width   = shot->width,
                         .height  = shot->height,
                         .format  = PNG_FORMAT_RGBA};
    choose_name("view", ".png", name);
    snprintf(path, sizeof path, "%s.png", name);
    if (viewing->pixels && write_png(&image, viewing->pixels, path, &error))
        viewing_notice(viewing, "saved %s", path);
    else if (error.message[0])
        viewing_notice(viewing, "%s", error.message);
    else
        viewing_notice(viewing, "%s cannot be written", path);
}

/* Makes the order that the panel describes, from where the view's camera is. */
static SaveOrder make_order(const Viewing *viewing)
{
    SaveOrder order = {.view   = viewing->view,
                       .kind   = viewing->save.kind,
                       .frames = viewing->save.frames,
                       .fps    = viewing->options->fps,
                       .camera = viewing->moved ? -1 : (int)viewing->camera,
                       .exr    = viewing->save.exr};
    char      ending[16];
    snprintf(ending, sizeof ending, "%s.%s", order.kind == SAVE_PICTURE ? "" : "-0000",
             order.exr ? "exr" : "png");
    choose_name(order.kind == SAVE_PICTURE ? "view" : save_names[order.kind], ending, order.name);
    if (viewing->save.width > 0 && viewing->save.height > 0) {
        order.view.width  = viewing->save.width;
        order.view.height = viewing->save.height;
    }
    if (viewing->save.samples > 0)
        order.view.samples = viewing->save.samples;
    return order;
}

void saving_start_or_stop(Viewing *viewing)
{
    const SaveOrder order = make_order(viewing);
    if (saver_state(viewing->saver).busy)
        saver_cancel(viewing->saver);
    else if (saver_start(viewing->saver, &order))
        viewing_notice(viewing, "saving %s", order.name);
}
