// Distance code of a scene; slot 0 holds the time, then one slot for each `param`.
layout(std140, set = 0, binding = 0) uniform KrsParameters { vec4 krs_parameter[2]; };

struct KrsSurface {
    float distance;
    vec3  color;
    float roughness;
    float metallic;
    vec3  emission;
    float specular;
    float ior;
    float transmission;
    vec3  absorption;
    float coat;
    float coat_roughness;
    vec3  sheen;
    float sheen_roughness;
    float thin_film_weight;
    float thin_film_thickness;
    float thin_film_ior;
    float specular_roughness_anisotropy;
    vec3  tangent;
    float subsurface_weight;
    vec3  subsurface_color;
    vec3  subsurface_radius;
    uint  component;
    uint  level;
    uint  instance;
    uint  material;
    vec3  normal;
};

// Everything that stays the same within a frame: call it first.
void krs_prepare();

// Never above the distance to the nearest surface; negative inside.
float krs_distance(vec3 p);

// How far a ray from p along a unit direction may go before it can meet a
// surface: at least the distance, and farther where polynomials or maps tell;
// negative inside, and where a surface without thickness lies between p and the
// last place, `footprint` behind.
float krs_along(vec3 p, vec3 direction, float footprint);

// To march by: never above the distance to the nearest surface, and not above 0
// in the same places as krs_distance.  What is far for its size is not looked
// at, nor what is smaller than the footprint.
float krs_distance_lod(vec3 p, float footprint);

// The direction in which krs_distance rises fastest at a surface, of any
// length, by derivatives; by differences over `reach` where there are none.
vec3 krs_gradient(vec3 p, float reach);

// What is at p: the component with the least distance.  `normal` is the
// gradient of krs_distance there, `footprint` the radius of a pixel, or 0.
KrsSurface krs_surface(vec3 p, vec3 normal, float footprint);

float krs_inverse_length(float square)
{
    return mix(0.0, inversesqrt(square), square > 0.0);
}

vec3 krs_normalize_vec3(vec3 a) { return a * krs_inverse_length(dot(a, a)); }

float krs_box_distance(vec3 p, vec3 center, vec3 half_sides)
{
    return length(max(abs(p - center) - half_sides, vec3(0.0)));
}

float krs_frame0;
float krs_frame1;

void krs_prepare()
{
    krs_frame0 = krs_parameter[1].x;
    // tests/golden/algebraic.krs:3
    krs_frame1 = abs(krs_frame0) * 1.0000001;
}

float krs_distance_1(vec3 p)
{
    // tests/golden/algebraic.krs:3
    vec3 v0 = min(max(p, vec3((-1.6529645))), vec3(1.6529645));
    float t1 = v0.x * v0.x;
    float t2 = v0.y * v0.y;
    float t3 = v0.z * v0.z;
    vec3 v4 = vec3(1.0, 0.0, 0.0) * v0.x;
    vec3 v5 = v4 + v4;
    float t6 = length(v5);
    float t7 = t1 * 1.0000001;
    float t8 = t6 * 1.0000001;
    vec3 v9 = v5 * t1;
    vec3 v10 = vec3(0.0, 1.0, 0.0) * v0.y;
    vec3 v11 = v10 + v10;
    float t12 = length(v11);
    float t13 = t2 * 1.0000001;
    float t14 = t12 * 1.0000001;
    vec3 v15 = v11 * t2;
    vec3 v16 = vec3(0.0, 0.0, 1.0) * v0.z;
    vec3 v17 = v16 + v16;
    float t18 = length(v17);
    float t19 = t3 * 1.0000001;
    float t20 = t18 * 1.0000001;
    vec3 v21 = v17 * t3;
    float t22 = ((t7 + (t7 + (t6 * t6))) + (t13 + (t13 + (t12 * t12)))) + (t19 + (t19 + (t18 * t18)));
    float t23 = ((t8 + t8) + (t14 + t14)) + (t20 + t20);
    float t24 = (((t1 * t1) + (t2 * t2)) + (t3 * t3)) - (krs_frame0 * (t3 + (t1 + t2)));
    float t25 = krs_frame1 + t22;
    vec3 v26 = (((v9 + v9) + (v15 + v15)) + (v21 + v21)) - ((v17 + (v5 + v11)) * krs_frame0);
    float t27 = length(v26);
    float t28 = t24 + (-0.2);
    float t29 = abs(t28);
    float t30 = t29 / max(t27, 1e-30);
    float t31 = sqrt((t29 / max(t25, 1e-30)));
    float t32 = min(t30, t31);
    float t33 = exp2((log2(max((t29 / max(t23, 1e-30)), 1e-37)) * 0.33333334));
    float t34 = min(t32, t33);
    float t35 = sqrt(sqrt((t29 * 0.33333325)));
    float t36 = min(t34, t35);
    float t37 = t36 * 3.0000007;
    float t38 = t23 + t37;
    float t39 = t25 + (t36 * t38);
    float t40 = t27 + (t36 * t39);
    float t41 = max((t40 + (t36 * (t39 + (t36 * (t37 + t38))))), 1e-30);
    float t42 = t36 - (((t36 * t40) - t29) / t41);
    float t43 = t42 * 3.0000007;
    float t44 = t23 + t43;
    float t45 = t25 + (t42 * t44);
    float t46 = t27 + (t42 * t45);
    float t47 = max((t46 + (t42 * (t45 + (t42 * (t43 + t44))))), 1e-30);
    float t48 = t42 - (((t42 * t46) - t29) / t47);
    float t49 = t48 * 3.0000007;
    float t50 = t23 + t49;
    float t51 = t25 + (t48 * t50);
    float t52 = t27 + (t48 * t51);
    float t53 = max((t52 + (t48 * (t51 + (t48 * (t49 + t50))))), 1e-30);
    float t54 = t48 - (((t48 * t52) - t29) / t53);
    float t55 = t27 + (t54 * (t25 + (t54 * (t23 + (t54 * 3.0000007)))));
    float t56 = sign(t28) * (t54 * min((t29 / max((t54 * t55), 1e-30)), 1.0));
    vec3 v57 = abs(p) - vec3(1.6529645);
    float t58 = max(v57.y, v57.z);
    float t59 = max(v57.x, t58);
    float t60 = min(max(t56, t59), 0.0) + length(vec2(length(max(v57, vec3(0.0))), max(t56, 0.0)));
    return t60;
}

float krs_distance_2(vec3 p)
{
    // tests/golden/algebraic.krs:4
    vec3 v0 = p - vec3(3.0, 0.0, 0.0);
    vec3 v1 = min(max(v0, vec3((-1.5156244))), vec3(1.5156244));
    float t2 = v1.x * v1.y;
    vec3 v3 = (vec3(0.0, 1.0, 0.0) * v1.x) + (vec3(1.0, 0.0, 0.0) * v1.y);
    float t4 = length(v3) + (abs(v1.z) * 0.50000006);
    float t5 = length(((vec3(0.0, 0.0, 1.0) * t2) + (v3 * v1.z)));
    float t6 = (v1.z * t2) + (-0.1);
    float t7 = abs(t6);
    float t8 = t7 / max(t5, 1e-30);
    float t9 = sqrt((t7 / max(t4, 1e-30)));
    float t10 = min(t8, t9);
    float t11 = exp2((log2(max((t7 * 1.9999998), 1e-37)) * 0.33333334));
    float t12 = min(t10, t11);
    float t13 = t12 * 0.50000006;
    float t14 = t4 + t13;
    float t15 = t5 + (t12 * t14);
    float t16 = t12 - (((t12 * t15) - t7) / max((t15 + (t12 * (t13 + t14))), 1e-30));
    float t17 = t16 * 0.50000006;
    float t18 = t4 + t17;
    float t19 = t5 + (t16 * t18);
    float t20 = t16 - (((t16 * t19) - t7) / max((t19 + (t16 * (t17 + t18))), 1e-30));
    float t21 = t20 * 0.50000006;
    float t22 = t4 + t21;
    float t23 = t5 + (t20 * t22);
    float t24 = t20 - (((t20 * t23) - t7) / max((t23 + (t20 * (t21 + t22))), 1e-30));
    float t25 = max((t24 * (t5 + (t24 * (t4 + (t24 * 0.50000006))))), 1e-30);
    float t26 = 1.5 - length(v0);
    float t27 = -abs((sign(t6) * (t24 * min((t7 / t25), 1.0))));
    float t28 = -min(t26, t27);
    return t28;
}

float krs_along_1(vec3 p, vec3 direction, float footprint)
{
    // tests/golden/algebraic.krs:3
    float t0 = mix(direction.x, 1e-18, abs(direction.x) < 1e-18);
    float t1 = ((-1.6529645) - p.x) / t0;
    float t2 = (1.6529645 - p.x) / t0;
    float t3 = max(min(t1, t2), 0.0);
    float t4 = min(max(t1, t2), 1e+30);
    float t5 = mix(direction.y, 1e-18, abs(direction.y) < 1e-18);
    float t6 = ((-1.6529645) - p.y) / t5;
    float t7 = (1.6529645 - p.y) / t5;
    float t8 = min(t6, t7);
    float t9 = max(t3, t8);
    float t10 = max(t6, t7);
    float t11 = min(t4, t10);
    float t12 = mix(direction.z, 1e-18, abs(direction.z) < 1e-18);
    float t13 = ((-1.6529645) - p.z) / t12;
    float t14 = (1.6529645 - p.z) / t12;
    float t15 = min(t13, t14);
    float t16 = max(t9, t15);
    float t17 = max(t13, t14);
    vec3 v18 = min(max((p + (direction * t16)), vec3((-1.6529645))), vec3(1.6529645));
    float t19 = v18.x * v18.x;
    float t20 = direction.x * v18.x;
    float t21 = t20 + t20;
    float t22 = direction.x * direction.x;
    float t23 = t19 * t21;
    float t24 = t19 * t22;
    float t25 = t21 * t22;
    float t26 = v18.y * v18.y;
    float t27 = direction.y * v18.y;
    float t28 = t27 + t27;
    float t29 = direction.y * direction.y;
    float t30 = t26 * t28;
    float t31 = t26 * t29;
    float t32 = t28 * t29;
    float t33 = v18.z * v18.z;
    float t34 = direction.z * v18.z;
    float t35 = t34 + t34;
    float t36 = direction.z * direction.z;
    float t37 = t33 * t35;
    float t38 = t33 * t36;
    float t39 = t35 * t36;
    float t40 = ((t24 + (t24 + (t21 * t21))) + (t31 + (t31 + (t28 * t28)))) + (t38 + (t38 + (t35 * t35)));
    float t41 = (((t19 * t19) + (t26 * t26)) + (t33 * t33)) - (krs_frame0 * (t33 + (t19 + t26)));
    float t42 = (((t23 + t23) + (t30 + t30)) + (t37 + t37)) - (krs_frame0 * (t35 + (t21 + t28)));
    float t43 = t41 + (-0.2);
    float t44 = sign(t43);
    float t45 = t43 * t44;
    float t46 = t42 * t44;
    float t47 = (t40 - (krs_frame0 * (t36 + (t22 + t29)))) * t44;
    float t48 = (((t25 + t25) + (t32 + t32)) + (t39 + t39)) * t44;
    float t49 = (((t22 * t22) + (t29 * t29)) + (t36 * t36)) * t44;
    float t50 = t45 * 4.0;
    float t51 = min((t50 / max((-t46), 1e-30)), 3.1622778e+08);
    float t52 = sqrt((t50 / max((-t47), 1e-30)));
    float t53 = min(t51, t52);
    float t54 = log2(max((t50 / max((-t48), 1e-30)), 1e-37)) * 0.33333334;
    float t55 = sqrt(sqrt((t50 / max((-t49), 1e-30))));
    float t56 = min(t53, t55);
    float t57 = exp2(t54);
    float t58 = min(t56, t57);
    float t59 = t46 * t58;
    float t60 = t58 * t58;
    float t61 = t47 * t60;
    float t62 = t58 * t60;
    float t63 = t48 * t62;
    float t64 = -t59;
    float t65 = (t61 * (-0.33333334)) - t59;
    float t66 = max(t64, t65);
    float t67 = ((t61 * (-0.6666667)) - t59) + (t63 * (-0.33333334));
    float t68 = max(t66, t67);
    float t69 = ((t64 - t61) - t63) - (t49 * (t58 * t62));
    float t70 = t44 * (t58 * min((t45 / max(max(t68, t69), 1e-30)), 1.0));
    float t71 = mix((t16 + t70), 1e+30, min(t11, t17) < t16);
    return t71;
}

float krs_along_2(vec3 p, vec3 direction, float footprint)
{
    // tests/golden/algebraic.krs:4
    vec3 v0 = p - vec3(3.0, 0.0, 0.0);
    vec3 v1 = min(max(v0, vec3((-1.5156244))), vec3(1.5156244));
    float t2 = v1.x * v1.y;
    float t3 = (v1.z * t2) + (-0.1);
    float t4 = sign(t3);
    // library:solids.krs
    float t5 = length(v0);
    float t6 = t5 - 1.5;
    // tests/golden/algebraic.krs:4
    float t7 = dot(direction, direction);
    float t8 = dot(v0, direction) / t7;
    float t9 = -t8;
    float t10 = length((v0 + (direction * t9)));
    float t11 = sqrt((max(((t10 + 1.5) * (1.5 - t10)), 0.0) / t7)) - t8;
    float t12 = mix((((t6 * (t5 + 1.5)) / t7) / max(t11, 1e-30)), 1e+30, any(bvec2((t9 < 0.0), (1.5 < t10))));
    float t13 = mix(t6, t12, 1.5 < t5);
    float t14 = max((-t13), 0.0);
    float t15 = mix(min(footprint, t14), footprint, (length((v0 - (direction * footprint))) - 1.5) < 0.0);
    float t16 = (v1.x * direction.y) + (v1.y * direction.x);
    float t17 = direction.x * direction.y;
    vec3 v18 = v0 - v1;
    float t19 = t3 * t4;
    float t20 = t4 * ((t2 * direction.z) + (v1.z * t16));
    float t21 = t4 * ((direction.z * t16) + (v1.z * t17));
    float t22 = t4 * (direction.z * t17);
    float t23 = t19 * 4.0;
    float t24 = min((t23 / max((-t20), 1e-30)), 2.1544347e+11);
    float t25 = sqrt((t23 / max((-t21), 1e-30)));
    float t26 = min(t24, t25);
    float t27 = log2(max((t23 / max((-t22), 1e-30)), 1e-37)) * 0.33333334;
    float t28 = exp2(t27);
    float t29 = min(t26, t28);
    float t30 = t20 * t29;
    float t31 = t29 * t29;
    float t32 = t21 * t31;
    float t33 = -t30;
    float t34 = (t32 * (-0.5)) - t30;
    float t35 = max(t33, t34);
    float t36 = (t33 - t32) - (t22 * (t29 * t31));
    float t37 = t4 * (t29 * min((t19 / max(max(t35, t36), 1e-30)), 1.0));
    float t38 = (v0.z * (v0.x * v0.y)) - 0.1;
    vec3 v39 = v0 - (direction * t15);
    float t40 = (v39.z * (v39.x * v39.y)) - 0.1;
    float t41 = abs(t38);
    float t42 = -(t15 * (t41 / max((t41 + abs(t40)), 1e-30)));
    float t43 = mix(abs(mix(t37, 0.0, 0.0 < dot(v18, v18))), t42, (sign(t40) * sign(t38)) < 0.0);
    float t44 = max(t13, t43);
    return t44;
}

float krs_distance_lod_1(vec3 p, float footprint)
{
    return krs_distance_1(p);
}

float krs_distance_lod_2(vec3 p, float footprint)
{
    return krs_distance_2(p);
}

vec4 krs_gradient_1(vec3 p, float reach)
{
    // tests/golden/algebraic.krs:3
    float t0 = p.x * p.x;
    float t1 = p.y * p.y;
    float t2 = p.z * p.z;
    float t3 = (((t0 * t0) + (t1 * t1)) + (t2 * t2)) - (krs_frame0 * (t2 + (t0 + t1)));
    float t4 = p.x * 2.0;
    float t5 = p.y * 2.0;
    float t6 = p.z * 2.0;
    vec3 v7 = vec3(((t4 * (t0 * 2.0)) - (krs_frame0 * t4)), ((t5 * (t1 * 2.0)) - (krs_frame0 * t5)), ((t6 * (t2 * 2.0)) - (krs_frame0 * t6)));
    vec3 v8 = krs_normalize_vec3(v7);
    float t9 = dot(p, v8);
    float t10 = t9 + (((t3 - 0.2) / max(length(v7), 1e-30)) - t9);
    vec3 v11 = vec3(dot(v8, vec3(1.0, 0.0, 0.0)), dot(v8, vec3(0.0, 1.0, 0.0)), dot(v8, vec3(0.0, 0.0, 1.0)));
    return vec4(v11, t10);
}

vec4 krs_gradient_2(vec3 p, float reach)
{
    // tests/golden/algebraic.krs:4
    vec3 v0 = p - vec3(3.0, 0.0, 0.0);
    // library:solids.krs
    float t1 = length(v0);
    // tests/golden/algebraic.krs:4
    float t2 = 1.5 - t1;
    float t3 = v0.x * v0.y;
    vec3 v4 = vec3((v0.y * v0.z), (v0.x * v0.z), t3);
    vec3 v5 = krs_normalize_vec3(v4);
    float t6 = dot(v0, v5);
    float t7 = t6 + ((((v0.z * t3) - 0.1) / max(length(v4), 1e-30)) - t6);
    float t8 = -(t7 + (abs(t7) - t7));
    float t9 = -min(t2, t8);
    // library:solids.krs
    float t10 = max(t1, 1e-30);
    // tests/golden/algebraic.krs:4
    bool b11 = t8 < t2;
    float t12 = mix((-(dot(v0, vec3(1.0, 0.0, 0.0)) / t10)), (-dot(v5, vec3(1.0, 0.0, 0.0))), b11);
    float t13 = mix((-(dot(v0, vec3(0.0, 1.0, 0.0)) / t10)), (-dot(v5, vec3(0.0, 1.0, 0.0))), b11);
    float t14 = mix((-(dot(v0, vec3(0.0, 0.0, 1.0)) / t10)), (-dot(v5, vec3(0.0, 0.0, 1.0))), b11);
    vec3 v15 = vec3((-t12), (-t13), (-t14));
    return vec4(v15, t9);
}

KrsSurface krs_surface_1(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_1(p);
    return KrsSurface(d, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 1u, uint(0.0), 1u, 0u, normal);
}

KrsSurface krs_surface_2(vec3 p, vec3 normal, float footprint)
{
    float d = krs_distance_2(p);
    return KrsSurface(d, vec3(0.6), 0.6, 0.0, vec3(0.0), 1.0, 1.5, 0.0, vec3(0.0), 0.0, 0.0, vec3(0.0), 0.5, 0.0, 0.5, 1.4, 0.0, vec3(0.0), 0.0, vec3(0.8), vec3(1.0), 2u, uint(0.0), 1u, 0u, normal);
}

float krs_distance(vec3 p)
{
    float d = krs_distance_1(p);
    d = min(d, krs_distance_2(p));
    return d;
}

float krs_along(vec3 p, vec3 direction, float footprint)
{
    float t = 1e30;
    t = min(t, krs_along_1(p, direction, footprint));
    t = min(t, krs_along_2(p, direction, footprint));
    return t;
}

float krs_distance_lod(vec3 p, float footprint)
{
    float d = krs_distance_lod_1(p, footprint);
    if (krs_box_distance(p, vec3(3.0, 0.0, 0.0), vec3(1.500006, 1.500003, 1.500003)) < max(d, 1e-30))
        d = min(d, krs_distance_lod_2(p, footprint));
    return d;
}

vec3 krs_gradient(vec3 p, float reach)
{
    vec4 nearest = vec4(0.0, 0.0, 0.0, 1e30), other;
    other = krs_gradient_1(p, reach);
    nearest = other.w < nearest.w ? other : nearest;
    other = krs_gradient_2(p, reach);
    nearest = other.w < nearest.w ? other : nearest;
    return nearest.xyz;
}

KrsSurface krs_surface(vec3 p, vec3 normal, float footprint)
{
    KrsSurface nearest = krs_surface_1(p, normal, footprint);
    KrsSurface other;
    other = krs_surface_2(p, normal, footprint);
    if (other.distance < nearest.distance)
        nearest = other;
    return nearest;
}

