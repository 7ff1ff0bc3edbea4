/*
 * quaternions.c: quaternions, and 2x2 matrices of them that stand for conformal maps of space.
 */
#include "tests/oracle/quaternions.h"

Quat quat(double w, Vec v) { return (Quat){w, v}; }

Quat pure(Vec v) { return (Quat){0, v}; }

Quat real(double w) { return (Quat){w, {0, 0, 0}}; }

static Quat quat_add(Quat p, Quat q) { return (Quat){p.w + q.w, vec_add(p.v, q.v)}; }

Quat quat_mul(Quat p, Quat q)
{
    Vec v = vec_add(vec_add(vec_scale(p.w, q.v), vec_scale(q.w, p.v)), vec_cross(p.v, q.v));
    return quat(p.w * q.w - vec_dot(p.v, q.v), v);
}

static Quat quat_inverse(Quat q)
{
    double square = q.w * q.w + vec_dot(q.v, q.v);
    return quat(q.w / square, vec_scale(-1 / square, q.v));
}

Matrix matrix_mul(Matrix m, Matrix n)
{
    return (Matrix){quat_add(quat_mul(m.a, n.a), quat_mul(m.b, n.c)),
                    quat_add(quat_mul(m.a, n.b), quat_mul(m.b, n.d)),
                    quat_add(quat_mul(m.c, n.a), quat_mul(m.d, n.c)),
                    quat_add(quat_mul(m.c, n.b), quat_mul(m.d, n.d))};
}

Quat matrix_apply(const Matrix *m, Vec p)
{
    Quat above = quat_add(quat_mul(m->a, pure(p)), m->b);
    Quat below = quat_add(quat_mul(m->c, pure(p)), m->d);
    return quat_mul(above, quat_inverse(below));
}
