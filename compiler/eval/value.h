/*
 * value.h: what expressions of the language evaluate to.
 *
 * Numbers known when the scene is compiled are plain doubles; a number, vector or truth value
 * that depends on a parameter, the time or the point is a node of the graph (VALUE_EXPRESSION).
 * Nothing else distinguishes the binding times: they are read off the node.
 */
#ifndef KRS_VALUE_H
#define KRS_VALUE_H

#include "compiler/front/syntax.h"
#include "compiler/shape/shape.h"

typedef enum ValueType {
    VALUE_ERROR, /* something went wrong and has been reported: goes with everything, silently */
    VALUE_NUMBER,
    VALUE_BOOLEAN,
    VALUE_EXPRESSION, /* a number, vector or truth value that is not known at compile time */
    VALUE_STRING,
    VALUE_RECORD, /* values with names, from JSON */
    VALUE_LIST,   /* 2 to 4 numbers are a vector; 3 also a colour */
    VALUE_FUNCTION,
    VALUE_SHAPE,
    VALUE_MAP,
    VALUE_MATERIAL,
    VALUE_TEXTURE
} ValueType;

typedef struct Value    Value;
typedef struct List     List;
typedef struct Record   Record;
typedef struct Function Function;

/* A `def`, a shape declaration, or a built-in function, with the names it can see. */
struct Function {
    const char               *name;
    const Syntax             *syntax;  /* SYNTAX_DEF or SYNTAX_SHAPE; NULL for built-in */
    const struct Builtin     *builtin; /* row of functions.def or ops.def */
    const struct Environment *closure;
};

struct Value {
    ValueType type;
    uint32_t  number_id; /* of a number that the author may change (value_authored); else 0 */
    union {
        double          number;
        bool            boolean;
        Node            node;
        const char     *string;
        const List     *list;
        const Record   *record;
        const Function *function;
        const Shape    *shape;
        const Map      *map;
        const Material *material;
        uint32_t        texture; /* its number in Graph.textures */
    };
};

/* A list may be in many others, so nothing about it is found by walking through all of it. */
struct List {
    size_t      count;
    Value      *items;
    BindingTime time;  /* the latest of its elements' */
    size_t      total; /* of elements, those of lists in it counted as often as they occur;
                          SIZE_MAX: that or more */
};

struct Record {
    size_t       count;
    const Value *names, *values; /* names are strings */
};

/* A list that grows. */
typedef struct Values {
    Value *items;
    size_t count, capacity;
} Values;

static inline Value value_error(void) { return (Value){.type = VALUE_ERROR}; }
static inline Value value_number(double number)
{
    return (Value){.type = VALUE_NUMBER, .number = number};
}

static inline Value value_boolean(bool truth)
{
    return (Value){.type = VALUE_BOOLEAN, .boolean = truth};
}

/* Makes the value of a shape or a map; NULL, whose reason has been reported, becomes VALUE_ERROR. */
static inline Value value_shape(const Shape *shape)
{
    return shape ? (Value){.type = VALUE_SHAPE, .shape = shape} : value_error();
}

static inline Value value_map(const Map *map)
{
    return map ? (Value){.type = VALUE_MAP, .map = map} : value_error();
}

#endif
