/*
 * lights.c: the light of each light: sums in a film, and means in a picture.
 *
 * On the device each light has a row of results, and the row of colours has the rest.  Rows of light
 * on a plate (plate.c) are kept with them.
 */
#include "runtime/film/lights.h"

#include "runtime/film/plate.h"
#include "runtime/tracer/renderer.h"
#include "runtime/tracer/rendering.h"

size_t lights_numbers(const KrsFilm *film) { return film->light_count * film_pixels(film); }

bool lights_make(KrsFilm *film)
{
    Gpu *gpu = &film->rendering->renderer->gpu;
    gpu_release(gpu, film->lights);
    film->lights      = NULL;
    film->light_count = (film->options.light_groups
                             ? (uint32_t)krs_light_count(film->rendering->scene)
                             : 0) +
                        plate_rows(film);
    if (film->light_count == 0)
        return true;
    film->lights = gpu_alloc(gpu, lights_numbers(film), sizeof *film->lights,
                             "keep the light of each light");
    return film->lights != NULL;
}

bool lights_finish(const KrsFilm *film, KrsPicture *picture)
{
    const size_t pixels = film_pixels(film);
    const size_t count  = film->light_count - plate_rows(film);
    if (count == 0)
        return true;
    picture->lights = gpu_alloc(&film->rendering->renderer->gpu, count * pixels,
                                sizeof *picture->lights, "make a picture");
    if (!picture->lights)
        return false;
    picture->light_count = (uint32_t)count;
    picture->stats.peak_memory_bytes += count * pixels * sizeof *picture->lights;
    for (size_t light = 0; light < count; light++)
        for (size_t k = 0; k < pixels; k++)
            for (int i = 0; i < 3; i++) {
                const float sum                       = film->lights[light * pixels + k][i];
                picture->lights[k * count + light][i] = sum / (float)film->samples;
                if (picture->color)
                    picture->color[4 * k + (size_t)i] += sum;
            }
    return true;
}
