/*
 * present.c: pictures as their scene wants them shown.
 */
#include "compiler/passes/compile.h"
#include "runtime/display/display.h"

KrsStatus krs_picture_to_srgb8(const KrsPicture *picture, const KrsScene *scene, double stops,
                               uint32_t channels, uint8_t *pixels)
{
    if ((channels != 3 && channels != 4) || !picture->color)
        return KRS_BAD_ARGUMENT;
    const KrsImage image = krs_scene_image(scene);
    DisplayOptions how   = {.exposure      = image.exposure + stops,
                            .white_balance = {image.white_balance[0], image.white_balance[1]}};
    if (image.tone_map)
        tone_map_find(image.tone_map, &how.tone_map); /* the compiler knows its name */
    display_to_srgb8(picture, &how, channels, pixels);
    return KRS_OK;
}
