#version 450
layout(local_size_x = 1) in;
vec4 krs_parameter[@slots@];
const int KRS_MAX_STEPS = 512;
@scene@
@trace@
// Where a ray is in the box: from x to y.
vec2 krs_inside(vec3 origin, vec3 direction)
{
    vec3 middle = (@center@ - origin) / direction, sides = @half@ / abs(direction);
    vec3 first = middle - sides, last = middle + sides;
    return vec2(max(max(first.x, first.y), first.z), min(min(last.x, last.y), last.z));
}

// What a ray has met at t; a pixel is so wide at distance 1.
KrsSurface krs_seen(vec3 origin, vec3 direction, float t, float pixel)
{
    vec3  p = origin + t * direction;
    float reach = max(0.5 * pixel * t, 1e-4 * max(max(abs(p.x), abs(p.y)), abs(p.z)));
    return krs_surface(p, krs_normal_at(p, reach), 0.5 * pixel * t);
}

// It calls what a shader of an engine calls, and is left out.
void main()
{
    krs_prepare();
    vec3  origin = krs_parameter[0].xyz, direction = vec3(0.0, 0.0, 1.0);
    vec2  inside = krs_inside(origin, direction);
    float t;
    if (krs_trace(origin, direction, inside.x, inside.y, 0.001, t))
        krs_parameter[0].x = krs_seen(origin, direction, t, 0.001).roughness;
}
