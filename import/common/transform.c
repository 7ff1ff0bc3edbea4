/*
 * transform.c: affine maps of imported files, as methods of the language.
 *
 * Every matrix is a mirror or none, then a rotation, a scaling along the axes, and
 * another rotation (its singular value decomposition).  Files mostly have matrices
 * of which one or two of these suffice.
 */
#include "import/common/transform.h"

#include <math.h>
#include <string.h>

#include "compiler/base/vec.h"

static const double CLOSE = 1e-9; /* files have twelve digits at most */

Transform transform_identity(void)
{
    return (Transform){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {0, 0, 0}};
}

Transform transform_move(const double by[3])
{
    Transform transform = transform_identity();
    memcpy(transform.shift, by, sizeof transform.shift);
    return transform;
}

Transform transform_scale(const double by[3])
{
    return (Transform){{{by[0], 0, 0}, {0, by[1], 0}, {0, 0, by[2]}}, {0, 0, 0}};
}

Transform transform_rotate(int axis, double angle)
{
    Transform transform = transform_identity();
    int       a = (axis + 1) % 3, b = (axis + 2) % 3;
    double    quarters = angle / (acos(-1) / 2), whole = round(quarters);
    bool      square     = fabs(quarters - whole) < 1e-12; /* right angles have no noise */
    double    c          = square ? round(cos(angle)) : cos(angle);
    double    s          = square ? round(sin(angle)) : sin(angle);
    transform.rows[a][a] = transform.rows[b][b] = c;
    transform.rows[a][b]                        = -s;
    transform.rows[b][a]                        = s;
    return transform;
}

bool transform_invert(Transform *transform)
{
    const double(*a)[3] = (const double(*)[3])transform->rows;
    Transform inverse   = transform_identity();
    double    shift[3], determinant = 0;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            int r = (k + 1) % 3, s = (k + 2) % 3, c = (i + 1) % 3, d = (i + 2) % 3;
            inverse.rows[i][k] = a[r][c] * a[s][d] - a[r][d] * a[s][c];
        }
    for (int k = 0; k < 3; k++)
        determinant += a[0][k] * inverse.rows[k][0];
    if (!(fabs(determinant) > 0))
        return false;
    for (int i = 0; i < 9; i++)
        inverse.rows[i / 3][i % 3] /= determinant;
    transform_apply(&inverse, transform->shift, shift);
    for (int i = 0; i < 3; i++)
        inverse.shift[i] = -shift[i];
    *transform = inverse;
    return true;
}

void transform_apply(const Transform *transform, const double q[3], double to[3])
{
    double moved[3];
    for (int i = 0; i < 3; i++)
        moved[i] = dot3(transform->rows[i], q) + transform->shift[i];
    memcpy(to, moved, sizeof moved);
}

Transform transform_chain(const Transform *first, const Transform *then)
{
    Transform both;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            both.rows[i][k] = 0;
            for (int j = 0; j < 3; j++)
                both.rows[i][k] += then->rows[i][j] * first->rows[j][k];
        }
    transform_apply(then, first->shift, both.shift);
    return both;
}

Transform transform_mirrored(const Transform *transform)
{
    Transform mirror = transform_scale((double[]){1, 1, -1}),
              half   = transform_chain(&mirror, transform);
    return transform_chain(&half, &mirror);
}

/* Computes what lengths become: the matrix times its transpose the other way round. */
static void gram(const Transform *transform, double g[3][3])
{
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            g[i][k] = 0;
            for (int j = 0; j < 3; j++)
                g[i][k] += transform->rows[j][i] * transform->rows[j][k];
        }
}

static double determinant(const Transform *transform)
{
    double across[3];
    cross3(transform->rows[0], transform->rows[1], across);
    return dot3(across, transform->rows[2]);
}

double transform_factor(const Transform *transform)
{
    double g[3][3], size, slack;
    gram(transform, g);
    size      = g[0][0];
    slack     = CLOSE * size;
    bool same = fabs(g[1][1] - size) <= slack && fabs(g[2][2] - size) <= slack &&
                fabs(g[0][1]) <= slack && fabs(g[0][2]) <= slack && fabs(g[1][2]) <= slack;
    return same && size > 0 ? sqrt(size) : 0;
}

bool transform_flatten(Transform *transform)
{
    double(*rows)[3] = transform->rows;
    if (rows[0][2] != 0 || rows[1][2] != 0 || rows[2][0] != 0 || rows[2][1] != 0)
        return false;
    double area         = fabs(rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0]);
    rows[2][2]          = sqrt(area); /* a similarity of the plane is one of space */
    transform->shift[2] = 0;
    return area > 0;
}

/* ---- as methods ---- */

static void add_vector(Text *text, const char *method, const double v[3], const char *end)
{
    double rounded[3];
    for (int i = 0; i < 3; i++)
        rounded[i] = import_rounded(v[i]);
    text_add(text, method);
    import_add_vector(text, rounded, 3);
    text_add(text, end);
}

static void write_mirror(Text *text, Transform *transform)
{
    int axis = 0, negative = 0;
    for (int i = 0; i < 3; i++)
        if (transform->rows[i][i] < 0) {
            axis = i;
            negative++;
        }
    axis              = negative == 1 ? axis : 0;
    double    by[3]   = {axis == 0 ? -1 : 1, axis == 1 ? -1 : 1, axis == 2 ? -1 : 1};
    double    away[3] = {axis == 0, axis == 1, axis == 2};
    Transform mirror  = transform_scale(by);
    *transform        = transform_chain(&mirror, transform);
    add_vector(text, ".transform(reflect(plane(", away, ", 0)))");
}

/* Writes a rotation: rows are of length 1, square to each other, and right-handed. */
static void write_rotation(Text *text, double rows[3][3])
{
    double axis[3] = {rows[2][1] - rows[1][2], rows[0][2] - rows[2][0], rows[1][0] - rows[0][1]};
    double sine    = sqrt(dot3(axis, axis)) / 2;
    double cosine  = (rows[0][0] + rows[1][1] + rows[2][2] - 1) / 2;
    double angle   = atan2(sine, cosine) * 180 / acos(-1);
    if (angle < 1e-7)
        return;
    if (sine < 1e-6 && cosine < 0) { /* half a turn: rows are 2 n n' - 1 */
        int largest = 0;
        for (int i = 1; i < 3; i++)
            largest = rows[i][i] > rows[largest][largest] ? i : largest;
        double sign = dot3(axis, rows[largest]) + axis[largest] < 0 ? -1 : 1;
        for (int i = 0; i < 3; i++)
            axis[i] = sign * (rows[i][largest] + rows[largest][i]) / 2;
        axis[largest] += sign;
    }
    double length = sqrt(dot3(axis, axis));
    for (int i = 0; i < 3; i++)
        axis[i] = fabs(axis[i]) < 1e-11 * length ? 0 : axis[i] / length;
    for (int i = 0; i < 3; i++)
        if (axis[i] == -1) { /* about an axis in its own direction */
            axis[i] = 1;
            angle   = -angle;
        }
    add_vector(text, ".rotate(", axis, ", ");
    import_add_number(text, import_rounded(angle));
    text_add(text, "deg)");
}

/* Rotates g and v so that g[a][b] is 0 (Jacobi). */
static void jacobi_rotate(double g[3][3], double v[3][3], int a, int b)
{
    if (fabs(g[a][b]) <= 1e-13 * sqrt(fabs(g[a][a] * g[b][b])))
        return;
    double angle = atan2(2 * g[a][b], g[a][a] - g[b][b]) / 2, c = cos(angle), s = sin(angle);
    for (int i = 0; i < 3; i++) {
        double x = g[i][a], y = g[i][b];
        g[i][a] = c * x + s * y;
        g[i][b] = c * y - s * x;
        x = v[i][a], y = v[i][b];
        v[i][a] = c * x + s * y;
        v[i][b] = c * y - s * x;
    }
    for (int i = 0; i < 3; i++) {
        double x = g[a][i], y = g[b][i];
        g[a][i] = c * x + s * y;
        g[b][i] = c * y - s * x;
    }
}

/* Writes a stretch: columns of v are the directions that a matrix stretches, by the square roots of
   g's diagonal. */
static bool write_stretch(Text *text, const Transform *transform)
{
    double g[3][3], v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, by[3], before[3][3], after[3][3];
    gram(transform, g);
    for (int sweep = 0; sweep < 12; sweep++)
        for (int pair = 0; pair < 3; pair++)
            jacobi_rotate(g, v, pair == 2 ? 1 : 0, pair == 0 ? 1 : 2);
    for (int i = 0; i < 3; i++)
        by[i] = sqrt(fmax(g[i][i], 0));
    double most = fmax(by[0], fmax(by[1], by[2]));
    for (int i = 0; i < 3; i++)
        if (!(by[i] > CLOSE * most))
            return false;
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            before[k][i] = v[i][k];
            after[i][k]  = 0;
            for (int j = 0; j < 3; j++)
                after[i][k] += transform->rows[i][j] * v[j][k] / by[k];
        }
    write_rotation(text, before);
    add_vector(text, ".scale(", by, ")");
    write_rotation(text, after);
    return true;
}

bool transform_write(Text *text, const Transform *transform)
{
    Transform plain  = *transform;
    double    volume = determinant(transform);
    if (!isfinite(volume) || volume == 0)
        return false;
    if (volume < 0)
        write_mirror(text, &plain);
    double factor = transform_factor(&plain);
    if (factor > 0) {
        if (fabs(factor - 1) > CLOSE) {
            text_add(text, ".scale(");
            import_add_number(text, import_rounded(factor));
            text_add(text, ")");
        }
        for (int i = 0; i < 3; i++)
            for (int k = 0; k < 3; k++)
                plain.rows[i][k] /= factor;
        write_rotation(text, plain.rows);
    } else if (!write_stretch(text, &plain)) {
        return false;
    }
    if (transform->shift[0] != 0 || transform->shift[1] != 0 || transform->shift[2] != 0)
        add_vector(text, ".move(", transform->shift, ")");
    return true;
}
