/* field.c: the distance of the meshed components, cut by a box. */
#include "compiler/mesh/field.h"

#include "compiler/base/vec.h"
#include "compiler/program.h"

/* The distance to the surface of the box, negative inside. */
static double distance_to_cut(const MeshField *field, const double point[3])
{
    double outside = 0, inside = -INFINITY;
    for (int k = 0; k < 3; k++) {
        double excess = fmax(field->low[k] - point[k], point[k] - field->high[k]);
        outside += excess > 0 ? excess * excess : 0;
        inside = fmax(inside, excess);
    }
    return outside > 0 ? sqrt(outside) : inside;
}

double field_distance(const MeshField *field, const double point[3])
{
    double distance = frame_component_distance(field->frame, field->component, point);
    return field->cut ? fmax(distance, distance_to_cut(field, point)) : distance;
}

bool field_normal(const MeshField *field, const double point[3], double step, double normal[3])
{
    for (int k = 0; k < 3; k++) {
        double before[3] = {point[0], point[1], point[2]},
               after[3]  = {point[0], point[1], point[2]};
        before[k] -= step;
        after[k] += step;
        normal[k] = field_distance(field, after) - field_distance(field, before);
    }
    if (normalize3(normal))
        return true;
    normal[0] = normal[1] = normal[2] = 0;
    return false;
}
