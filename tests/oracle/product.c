/*
 * product.c: scenes are compiled from text, as an author's would be, and asked point by point.
 */
#include "tests/oracle/product.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

void scene_write(SceneText *text, const char *format, ...)
{
    size_t  left = sizeof text->bytes - text->length;
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text->bytes + text->length, left, format, arguments);
    va_end(arguments);
    assert_in_range(length, 0, left - 1);
    text->length += (size_t)length;
}

static void print_diagnostic(void *user, const KrsDiagnostic *diagnostic)
{
    (void)user;
    if (diagnostic->error)
        fprintf(stderr, "%s\n", diagnostic->text);
}

/* With a camera, or the compiler would look for one that sees everything: that takes it longer than
   all the rest. */
static KrsStatus compile(const char *text, const KrsOptions *options, KrsScene **scene)
{
    static const char camera[] = "\ncamera { eye: [0, 0, 9], target: [0, 0, 0] }\n";
    if (strstr(text, "camera {"))
        return krs_compile_text(text, strlen(text), "oracle.krs", options, scene);
    size_t length = strlen(text);
    char  *seen   = malloc(length + sizeof camera);
    memcpy(seen, text, length);
    memcpy(seen + length, camera, sizeof camera);
    KrsStatus status = krs_compile_text(seen, strlen(seen), "oracle.krs", options, scene);
    free(seen);
    return status;
}

static bool wants_research, wants_outlines;

void product_wants_research(void) { wants_research = true; }
void product_wants_outlines(void) { wants_outlines = true; }

Product product_compile(const char *text)
{
    Product    product = {0};
    KrsOptions options = {
        .diagnostic = print_diagnostic, .research = wants_research, .outlines = wants_outlines};
    KrsStatus status = compile(text, &options, &product.scene);
    if (status != KRS_OK)
        fail_msg("status %d for the scene:\n%s", (int)status, text);
    assert_int_equal(krs_state_new(product.scene, &product.state), KRS_OK);
    return product;
}

Product product_format(const char *format, ...)
{
    char    text[4096];
    va_list arguments;
    va_start(arguments, format);
    int length = vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    assert_in_range(length, 0, sizeof text - 1);
    return product_compile(text);
}

void product_free(Product *product)
{
    krs_state_free(product->state);
    krs_scene_free(product->scene);
    *product = (Product){0};
}

double product_distance(const Product *product, Vec point)
{
    double distance, points[1][3] = {{point.x, point.y, point.z}};
    krs_distance(product->state, (const double(*)[3])points, 1, &distance);
    return distance;
}

double product_field(const void *product, Vec point) { return product_distance(product, point); }

KrsHit product_probe(const Product *product, Vec point)
{
    KrsHit hit;
    double points[1][3] = {{point.x, point.y, point.z}};
    krs_probe(product->state, (const double(*)[3])points, 1, &hit);
    return hit;
}

KrsHit product_raycast(const Product *product, Vec origin, Vec direction, double farthest,
                       double tolerance)
{
    KrsHit hit;
    double origins[1][3]    = {{origin.x, origin.y, origin.z}};
    double directions[1][3] = {{direction.x, direction.y, direction.z}};
    krs_raycast(product->state, (const double(*)[3])origins, (const double(*)[3])directions, 1,
                farthest, tolerance, &hit);
    return hit;
}

void product_keeps_claim(const Product *product, const char *what, double region, uint64_t seed)
{
    KrsComponent component;
    Random       random = {seed};
    assert_int_equal(krs_component(product->scene, 0, &component), KRS_OK);
    for (int i = 0; component.exact && i < 1000; i++) {
        Vec    point  = random_in_cube(&random, region);
        KrsHit hit    = product_probe(product, point);
        Vec    normal = vec(hit.normal[0], hit.normal[1], hit.normal[2]);
        double rest   = product_distance(product, vec_sub(point, vec_scale(hit.distance, normal)));
        if (hit.distance > 0 && fabs(rest) > 1e-4)
            fail_msg("%s claims to be exact, but from (%g, %g, %g), %.9g away, the way down the "
                     "gradient ends %.9g away",
                     what, point.x, point.y, point.z, hit.distance, rest);
    }
}
