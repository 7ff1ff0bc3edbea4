/* similarity.c: similarities, and a search for how far copies reach. */
#include "mesh/similarity.h"

#include "compiler/base/vec.h"

const double similarity_identity[3][4] = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

/* Maps x to x - 2 (normal . x - offset) normal. */
void similarity_mirror(const double normal[3], double offset, double matrix[3][4])
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            matrix[i][k] = (i == k) - 2 * normal[i] * normal[k];
        matrix[i][3] = 2 * offset * normal[i];
    }
}

void similarity_map(double scale, const double rows[3][3], const double shift[3],
                    double matrix[3][4])
{
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            matrix[i][k] = scale * rows[i][k];
        matrix[i][3] = shift[i];
    }
}

void similarity_product(const double a[3][4], const double b[3][4], double matrix[3][4])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 4; k++)
            matrix[i][k] = a[i][0] * b[0][k] + a[i][1] * b[1][k] + a[i][2] * b[2][k] +
                           (k == 3 ? a[i][3] : 0);
}

static void similarity_apply(const double matrix[3][4], const double point[3], double image[3])
{
    for (int i = 0; i < 3; i++)
        image[i] = dot3(matrix[i], point) + matrix[i][3];
}

double similarity_scale(const double matrix[3][4]) { return length3(matrix[0]); }

/* ---- reach ---- */

/* Finds the direction in the item's own space, longer by the scale; returns what the shift adds. */
static double to_item_space(const double matrix[3][4], const double direction[3], double own[3])
{
    double added = 0;
    own[0] = own[1] = own[2] = 0;
    for (int i = 0; i < 3; i++) {
        add_scaled3(own, own, direction[i], matrix[i]);
        added += direction[i] * matrix[i][3];
    }
    return added;
}

static double reach_of_box(Box box, const double direction[3])
{
    double sum = 0;
    for (int k = 0; k < 3; k++) {
        Range side = box.axis[k];
        if (direction[k] != 0)
            sum += direction[k] * (direction[k] > 0 ? side.high : side.low);
    }
    return sum;
}

static double reach_of_mesh(const KrsMesh *mesh, const double direction[3])
{
    double most = -INFINITY;
    for (size_t i = 0; i < mesh->vertex_count; i++)
        most = fmax(most, dot3(mesh->vertices[i], direction));
    return most;
}

static double reach_of_bounds(const struct ItemBounds *bounds, const double direction[3])
{
    if (box_is_empty(bounds->box))
        return -INFINITY;
    return fmin(reach_of_box(bounds->box, direction),
                dot3(direction, bounds->ball.centre) + length3(direction) * bounds->ball.radius);
}

double reach_along(ReachSearch *search, size_t number, const double matrix[3][4],
                   const double direction[3], double least)
{
    const KrsItem *item = &search->assembly->items[number];
    double         own[3], added = to_item_space(matrix, direction, own);
    double         most = added + reach_of_bounds(&search->bounds[number], own);
    if (most <= least)
        return least;
    if (search->visits == 0)
        return INFINITY;
    search->visits--;
    if (item->mesh)
        return fmax(least, added + reach_of_mesh(item->mesh, own));
    if (item->count == 0)
        return most;
    for (size_t i = item->first; i < item->first + item->count; i++) {
        const KrsTransform *transform = &search->assembly->transforms[i];
        double              product[3][4];
        similarity_product(matrix, transform->matrix, product);
        least = reach_along(search, transform->item, (const double(*)[4])product, direction, least);
    }
    return least;
}

/* ---- bounds ---- */

static Box box_of_mesh(const KrsMesh *mesh)
{
    Box box = box_empty;
    for (size_t i = 0; i < mesh->vertex_count; i++) {
        Box point;
        for (int k = 0; k < 3; k++)
            point.axis[k] = (Range){mesh->vertices[i][k], mesh->vertices[i][k]};
        box = box_hull(box, point);
    }
    return box;
}

static Box transform_box(const double matrix[3][4], Box box)
{
    Range rows[3][3], shift[3];
    for (int i = 0; i < 3; i++) {
        shift[i] = (Range){matrix[i][3], matrix[i][3]};
        for (int k = 0; k < 3; k++)
            rows[i][k] = (Range){matrix[i][k], matrix[i][k]};
    }
    return box_move(box_rotate(box, rows), shift);
}

static Ball transform_ball(const double matrix[3][4], Ball ball)
{
    Ball image = {.radius = ball.radius};
    if (ball.radius < 0 || isinf(ball.radius))
        return image;
    similarity_apply(matrix, ball.centre, image.centre);
    image.radius *= similarity_scale(matrix);
    return image;
}

void find_item_bounds(ReachSearch *search, size_t number)
{
    const KrsItem     *item   = &search->assembly->items[number];
    struct ItemBounds *bounds = &search->bounds[number];
    if (item->mesh)
        bounds->box = box_of_mesh(item->mesh);
    if (item->count == 0) {
        bounds->ball = ball_around(bounds->box);
        return;
    }
    *bounds = (struct ItemBounds){box_empty, {.radius = -1}};
    for (size_t i = item->first; i < item->first + item->count; i++) {
        const KrsTransform *transform   = &search->assembly->transforms[i];
        const double(*matrix)[4]        = (const double(*)[4])transform->matrix;
        const struct ItemBounds *placed = &search->bounds[transform->item];
        if (box_is_empty(placed->box))
            continue;
        bounds->box  = box_hull(bounds->box, transform_box(matrix, placed->box));
        bounds->ball = ball_hull(bounds->ball, transform_ball(matrix, placed->ball));
    }
}
