// export_osl.h: what the Open Shading Language has built in, for shaders that `krs export --to blender-osl` writes, in C++20; P is set
// by the test, in Blender's coordinates.
#include <cmath>
#include <cstdio>

struct vector {
    float x, y, z;
    vector() = default;
    vector(float a) : x(a), y(a), z(a) {}
    vector(float a, float b, float c) : x(a), y(b), z(c) {}
    float &operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
};
typedef vector point, color, normal;

#define ON_COMPONENTS(op)                                                   \
    inline vector operator op(vector a, vector b)                           \
    {                                                                       \
        return {a[0] op b[0], a[1] op b[1], a[2] op b[2]};                  \
    }                                                                       \
    inline vector operator op(vector a, float b) { return a op vector(b); } \
    inline vector operator op(float a, vector b) { return vector(a) op b; }
ON_COMPONENTS(+)
ON_COMPONENTS(-)
ON_COMPONENTS(*)
ON_COMPONENTS(/)
inline vector operator-(vector a) { return 0.0f - a; }

// OSL calls functions of these names for operators of structs.
#define ON_STRUCTS(op, name)                                                     \
    template <class A, class B> auto operator op(A a, B b)->decltype(name(a, b)) \
    {                                                                            \
        return name(a, b);                                                       \
    }
ON_STRUCTS(+, __operator__add__)
ON_STRUCTS(-, __operator__sub__)
ON_STRUCTS(*, __operator__mul__)
ON_STRUCTS(/, __operator__div__)
template <class A> auto operator-(A a) -> decltype(__operator__neg__(a))
{
    return __operator__neg__(a);
}

using std::ceil;
using std::cosh;
using std::exp;
using std::exp2;
using std::fabs;
using std::floor;
using std::log;
using std::log2;
using std::sinh;
using std::sqrt;
using std::tanh;
inline float  min(float a, float b) { return b < a ? b : a; }
inline float  max(float a, float b) { return a < b ? b : a; }
inline int    min(int a, int b) { return b < a ? b : a; }
inline int    max(int a, int b) { return a < b ? b : a; }
inline float  dot(vector a, vector b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline float  length(vector a) { return sqrt(dot(a, a)); }
inline vector cross(vector a, vector b)
{
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline vector normalize(vector a) { return a / length(a); }

static vector P, N;
inline vector Dx(vector) { return {0, 0, 0}; }
inline vector Dy(vector) { return {0, 0, 0}; }
inline vector transform(const char *, vector v) { return v; }
inline vector transform(const char *, const char *, vector v) { return v; }
