/*
 * print.c: the elaborated scene as indented text.
 */
#include "compiler/shape/scene.h"

static void print_indent(Text *out, uint32_t depth)
{
    for (uint32_t i = 0; i < depth; i++)
        text_add(out, "  ");
}

static void print_node(const Scene *scene, Node node, Text *out)
{
    const Expr *expr = &scene->graph->items[node];
    if (expr->op != OP_CONSTANT || expr->type > TYPE_VEC4) {
        text_format(out, "%%%u", node);
        return;
    }
    for (uint32_t i = 0; i < expr->type; i++) {
        text_add(out, i ? ", " : expr->type > 1 ? "[" : "");
        text_number(out, expr->number[i]);
    }
    text_add(out, expr->type > 1 ? "]" : "");
}

static void print_box(Box box, Text *out)
{
    text_add(out, "  box");
    for (int i = 0; i < 3; i++)
        text_format(out, " %.6g..%.6g", box.axis[i].low, box.axis[i].high);
}

/* Prints blend, and the numbers of the kind (shape.h). */
static void print_values(const Scene *scene, const Shape *shape, Text *out)
{
    if (shape->blend.width != NODE_NONE)
        text_format(out, "  blend %s", blend_info[shape->blend.kind].spelling);
    const Node numbers[] = {shape->blend.width, shape->blend.steps, shape->values[0],
                            shape->values[1]};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
        if (numbers[i] != NODE_NONE) {
            text_add(out, i == 0 ? " " : "  ");
            print_node(scene, numbers[i], out);
        }
}

/* Prints "similarity" or "inversion", and the numbers of the map (shape.h). */
static void print_map(const Scene *scene, const Map *map, Text *out)
{
    text_add(out, map->pole == NODE_NONE ? "similarity" : "inversion");
    text_add(out, "  scale ");
    print_node(scene, map->scale, out);
    text_add(out, "  rows");
    for (int i = 0; i < 3; i++) {
        text_add(out, " ");
        print_node(scene, map->rows[i], out);
    }
    text_add(out, "  shift ");
    print_node(scene, map->shift, out);
    if (map->pole == NODE_NONE)
        return;
    text_add(out, "  pole ");
    print_node(scene, map->pole, out);
}

static void print_shape(const Scene *scene, const Sources *sources, const Shape *shape,
                        uint32_t depth, Text *out)
{
    print_indent(out, depth);
    text_add(out, shape->kind == SHAPE_PRIMITIVE ? shape->name : shape_info[shape->kind].name);
    if (shape->span.source) {
        Position position = source_position(&sources->items[shape->span.source], shape->span.start);
        text_format(out, "  %s:%u:%u", sources->items[shape->span.source].name, position.line,
                    position.column);
    }
    print_box(shape->box, out);
    text_format(out, "  slope %.6g%s", shape->slope, shape->exact ? " exact" : "");
    if (shape->kind == SHAPE_PRIMITIVE && shape->derived > 1 + 1e-9)
        text_format(out, " (derived %.6g)", shape->derived);
    print_values(scene, shape, out);
    if (shape->material)
        text_format(out, "  %s", shape->material->name);
    if (shape->map.scale != NODE_NONE) {
        text_add(out, "  ");
        print_map(scene, &shape->map, out);
    }
    text_add(out, "\n");
    for (uint32_t i = 0; i < shape->stage_count; i++) {
        const SequenceStage *stage = &shape->stages[i];
        if (stage->kind == SEQUENCE_KERNEL) {
            print_shape(scene, sources, shape->children[stage->kernel], depth + 1, out);
            continue;
        }
        print_indent(out, depth + 1);
        if (stage->kind == SEQUENCE_MAP)
            print_map(scene, &stage->map, out);
        else {
            bool sphere = stage->kind == SEQUENCE_SPHERE;
            text_add(out, sphere ? "reflect sphere " : "reflect ");
            print_node(scene, sphere ? stage->centre : stage->normal, out);
            text_add(out, " ");
            print_node(scene, sphere ? stage->radius : stage->offset, out);
        }
        text_add(out, "\n");
    }
    for (uint32_t i = 0; shape->stage_count == 0 && i < shape->child_count; i++) /* else above */
        print_shape(scene, sources, shape->children[i], depth + 1, out);
}

void scene_print(const Scene *scene, const Sources *sources, Text *out)
{
    for (size_t i = 0; i < scene->parameters.count; i++) {
        const Parameter *parameter = &scene->parameters.items[i];
        text_format(out, "param %s slot %u", parameter->name, parameter->slot);
        for (uint32_t k = 0; k < parameter->components; k++)
            text_format(out, " %.6g in [%.6g, %.6g]", parameter->value[k], parameter->low[k],
                        parameter->high[k]);
        text_add(out, "\n");
    }
    for (size_t i = 0; i < scene->shown.count; i++) {
        text_format(out, "component %zu %s\n", i + 1, scene->shown.items[i].name);
        print_shape(scene, sources, scene->shown.items[i].shape, 1, out);
    }
    text_format(out, "cameras %zu\nlights %zu\nzones %zu\n", scene->cameras.count,
                scene->lights.count, scene->zone_count);
}
