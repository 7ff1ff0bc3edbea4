// The part of a light at p that nothing hides: a cone as wide as the light is looked along (Aaltonen 2018).
// No step is shorter than "least" and a hundredth of the way.
float krs_find_visible(vec3 p, vec3 toward, float last, float width, float least)
{
    float visible = 1.0, before = 1e20, t = 0.0;
    for (int i = 0; i < KRS_MAX_SHADOW_STEPS && t < last; i++) {
        float distance = krs_distance(p + t * toward);
        float back = distance * distance / (2.0 * before);
        float beside = sqrt(max(distance * distance - back * back, 0.0));
        visible = min(visible, beside / (width * max(t - back, 1e-6)));
        before = max(distance, 1e-6);
        t += max(distance, least + 0.01 * t);
        if (visible < 0.01)
            return 0.0;
    }
    visible = clamp(visible, 0.0, 1.0);
    return visible * visible * (3.0 - 2.0 * visible);
}

// How open p is to the sky: distances on the way outwards are as large as the way where nothing is near.
float krs_find_open(vec3 p, vec3 normal, float reach)
{
    float closed = 0.0, part = 1.0;
    for (int i = 1; i <= 4; i++) {
        float away = reach * 0.25 * float(i);
        closed += part * max(away - krs_distance(p + away * normal), 0.0) / away;
        part *= 0.6;
    }
    return clamp(1.0 - 0.45 * closed, 0.1, 1.0);
}

vec3 krs_sky(vec3 direction)
{
    float rise = clamp(direction.y, -1.0, 1.0), left = 1.0 - max(rise, 0.0);
    vec3  above = mix(KRS_ZENITH, KRS_HORIZON, left * left * left);
    return mix(above, KRS_GROUND, smoothstep(0.0, 0.25, -rise));
}

// The mean of the sky over the half around a normal, weighted by the cosine: parts of the zenith and of the ground, a fit
// that is off by 0.0023 at most.
vec3 krs_sky_around(vec3 normal)
{
    float rise = normal.y, square = rise * rise;
    vec2  sides = vec2(0.1039, 0.0708) + square * (vec2(0.0228, 0.0082) + square * vec2(0.0468, 0.0838));
    vec2  parts = vec2(0.45, 0.490625) - (1.0 - square) * sides + vec2(0.45, -0.490625) * rise;
    return KRS_HORIZON + parts.x * (KRS_ZENITH - KRS_HORIZON) + parts.y * (KRS_GROUND - KRS_HORIZON);
}

// What a microfacet surface sends to the eye of light from a direction (GGX; Smith; Schlick).
vec3 krs_reflect(KrsSurface surface, vec3 normal, vec3 eye, vec3 toward)
{
    float rise = dot(normal, toward), seen = max(dot(normal, eye), 1e-3);
    if (rise <= 0.0)
        return vec3(0.0);
    vec3  middle = normalize(toward + eye);
    float rough = max(surface.roughness * surface.roughness, 2e-3), square = rough * rough;
    float lobe = dot(normal, middle);
    lobe = lobe * lobe * (square - 1.0) + 1.0;
    float facets = square / (3.14159265 * lobe * lobe);
    float hidden = 0.5 / mix(2.0 * rise * seen, rise + seen, rough);
    vec3  head_on = mix(vec3(0.04), surface.color, surface.metallic);
    vec3  mirrored = head_on + (1.0 - head_on) * pow(1.0 - max(dot(eye, middle), 0.0), 5.0);
    vec3  below = (1.0 - mirrored) * (1.0 - surface.metallic) * surface.color / 3.14159265;
    return (below + mirrored * facets * hidden) * rise;
}

// The light that a hit at t sends along its ray.
vec3 krs_shade(vec3 origin, vec3 direction, float t, float pixel)
{
    vec3  p = origin + t * direction;
    float reach = max(0.5 * pixel * t, 1e-4 * max(max(abs(p.x), abs(p.y)), max(abs(p.z), t)));
    vec3  normal = krs_normal_at(p, reach);
    KrsSurface surface = krs_surface(p, normal, 0.5 * pixel * t);
    normal = dot(normal, direction) > 0.0 ? -normal : normal;
    vec3  start = p + 2.0 * reach * normal, eye = -direction;
    float open = krs_find_open(start, normal, KRS_OPEN_REACH);
    vec3  head_on = mix(vec3(0.04), surface.color, surface.metallic);
    vec3  fresnel = head_on + (max(vec3(1.0 - surface.roughness), head_on) - head_on) * pow(1.0 - max(dot(normal, eye), 0.0), 5.0);
    vec3  mirrored = mix(krs_sky(reflect(direction, normal)), krs_sky_around(normal), surface.roughness);
    vec3  sum = surface.emission + open * (fresnel * mirrored +
                (1.0 - fresnel) * (1.0 - surface.metallic) * surface.color * krs_sky_around(normal));
    for (int i = 0; i < KRS_LIGHTS; i++) {
        vec3  vector = krs_light_at[i].xyz, color = krs_light_color[i].rgb;
        float last = KRS_FARTHEST, width = krs_light_color[i].a;
        if (krs_light_at[i].w > 0.0) {
            vector -= start;
            last = length(vector);
            color /= last * last;
            width /= last;
            vector /= last;
            color *= krs_light_cone[i].w < -1.0 ? 1.0
                     : smoothstep(krs_light_cone[i].w, krs_light_edge[i], -dot(vector, krs_light_cone[i].xyz));
        }
        vec3 sent = krs_reflect(surface, normal, eye, vector);
        if (max(sent.r, max(sent.g, sent.b)) > 0.0)
            sum += sent * color * krs_find_visible(start, vector, last, width, reach);
    }
    return sum;
}

// Numbers of a display, of light.
vec3 krs_display(vec3 light)
{
    vec3 low = clamp(light, 0.0, 1.0);
    return mix(12.92 * low, 1.055 * pow(low, vec3(1.0 / 2.4)) - 0.055, step(0.0031308, low));
}
