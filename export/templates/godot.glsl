@scene@
@trace@
// Where a ray is in the box: from x to y.
vec2 krs_inside(vec3 origin, vec3 direction)
{
    vec3 middle = (KRS_CENTER - origin) / direction, sides = KRS_HALF / abs(direction);
    vec3 first = middle - sides, last = middle + sides;
    return vec2(max(max(first.x, first.y), first.z), min(min(last.x, last.y), last.z));
}

void fragment()
{
    KrsFrame krs = krs_prepare();
    bool  parallel = PROJECTION_MATRIX[3][3] > 0.5; // rays of a camera, or of a light
    mat4  to_view = VIEW_MATRIX * MODEL_MATRIX, to_box = inverse(to_view);
    vec3  end = (to_box * vec4(VERTEX, 1.0)).xyz + KRS_CENTER;
    vec3  origin = (to_box * vec4(parallel ? vec3(VERTEX.xy, 0.0) : vec3(0.0), 1.0)).xyz + KRS_CENTER;
    vec3  direction = normalize(end - origin);
    vec2  inside = krs_inside(origin, direction);
    if (parallel) {
        origin += inside.x * direction;
        inside = vec2(0.0, inside.y - inside.x);
    }
    // The height of a pixel at distance 1; of parallel rays, where they leave the box.
    float pixel = 2.0 / (abs(PROJECTION_MATRIX[1][1]) * VIEWPORT_SIZE.y), t;
    pixel *= parallel ? length(to_box[0].xyz) / max(inside.y, 1e-6) : 1.0;
    if (!krs_trace(origin, direction, max(inside.x, 0.0), inside.y, pixel, t))
        discard;
    vec3  p = origin + t * direction;
    float reach = max(0.5 * pixel * t, 1e-4 * max(max(abs(p.x), abs(p.y)), abs(p.z)));
    vec3  normal = krs_normal_at(p, reach);
    KrsSurface surface = krs_surface(p, normal, 0.5 * pixel * t);
    vec4  seen = to_view * vec4(p - KRS_CENTER, 1.0), clip = PROJECTION_MATRIX * seen;
    ALBEDO = surface.color;
    ROUGHNESS = surface.roughness;
    METALLIC = surface.metallic;
    EMISSION = surface.emission;
    NORMAL = normalize((to_view * vec4(surface.normal, 0.0)).xyz);
    LIGHT_VERTEX = seen.xyz;
    DEPTH = clip.z / clip.w;
#ifdef CURRENT_RENDERER
#if CURRENT_RENDERER == RENDERER_COMPATIBILITY
    DEPTH = 0.5 * DEPTH + 0.5;
#endif
#endif
}
