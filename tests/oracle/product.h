/*
 * product.h: the compiler as the oracle sees it, through krs/krs.h alone.
 */
#ifndef ORACLE_PRODUCT_H
#define ORACLE_PRODUCT_H

#include <stdarg.h>
#include <stddef.h>
#include <setjmp.h>
#include <cmocka.h>

#include "krs/krs.h"
#include "tests/oracle/brute.h"

/* A scene and its state at default parameters. */
typedef struct Product {
    KrsScene *scene;
    KrsState *state;
} Product;

/* A scene written piece by piece; too long a text fails the test. */
typedef struct SceneText {
    char   bytes[1 << 16];
    size_t length;
} SceneText;

void scene_write(SceneText *text, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Compiles a text; a refusal prints text and diagnostics and fails the test. */
Product product_compile(const char *text);
/* The scenes that are compiled from now on have what methods of research need. */
void product_wants_research(void);
/* They are for meshes, as those that the command meshes. */
void    product_wants_outlines(void);
Product product_format(const char *format, ...) __attribute__((format(printf, 1, 2)));
void    product_free(Product *product);

double product_distance(const Product *product, Vec point);
KrsHit product_probe(const Product *product, Vec point);
KrsHit product_raycast(const Product *product, Vec origin, Vec direction, double farthest,
                       double tolerance);

/* Fails the test when the first component claims to be exact and is not: from a point outside,
   as far as an exact distance says and against its gradient, lies the surface. */
void product_keeps_claim(const Product *product, const char *what, double region, uint64_t seed);

/* product_distance for judge.h: `product` is a Product. */
double product_field(const void *product, Vec point);

#endif
