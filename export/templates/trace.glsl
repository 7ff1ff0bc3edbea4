// ---- the tracer ----

// What is marched by.
float krs_march(vec3 p, float footprint) { return @march@; }

// A step is the distance, so no surface is passed by.  Where that would be shorter than a twentieth of a pixel the step is
// as long, and a surface is where the distance changes its sign within it.
bool krs_trace(vec3 origin, vec3 direction, float first, float last, float pixel, out float t)
{
    float magnitude = max(max(abs(origin.x), abs(origin.y)), abs(origin.z));
    t = first;
    float here = krs_march(origin + t * direction, 0.5 * pixel * t);
    float side = here < 0.0 ? -1.0 : 1.0;
    here *= side;
    for (int i = 0; i < KRS_MAX_STEPS && t < last; i++) {
        float least = 0.05 * pixel * t + 2.4e-7 * (magnitude + t);
        float next = t + max(here, least);
        float there = side * krs_march(origin + next * direction, 0.5 * pixel * next);
        if (there <= 0.0) {
            t = mix(t, next, here / max(here - there, 1e-30));
            return t < last;
        }
        t = next;
        here = there;
    }
    return false;
}

@normal@
