/*
 * methods.h: families of shapes, methods of shapes, and how a method is undone on points.
 */
#ifndef ORACLE_METHODS_H
#define ORACLE_METHODS_H

#include "tests/oracle/judge.h"
#include "tests/oracle/product.h"

/* In every scene; shapes are about as large as 1, and nowhere symmetric if they can help it. */
extern const char prelude[];

typedef struct Family {
    const char *name, *text;
} Family;

extern const Family families[];
extern const size_t family_count;

/* A family behind up to two methods. */
typedef struct Method Method;

typedef struct Case {
    const Family *family;
    const Method *methods[2];
    int           count;
    Product       alone; /* the family */
} Case;

typedef bool Undo(const Case *c, int before, Vec p);

struct Method {
    const char *name;           /* in methods.def, or a function or a block */
    const char *before, *after; /* of the text of a shape */
    Undo       *undo;           /* NULL: it goes by a distance */
    double      grows;          /* without `undo`: by at most, of the family's box */
    bool        keeps;          /* without `undo`: what was inside stays so */
    const char *refusals;       /* why the language may refuse it */
};

extern const Method methods[];
extern const size_t method_count;

/* Tells whether a point is inside of a whole case; `c` is a Case. */
bool inside_case(const void *c, Vec p);

#endif
