// The normal outside of the solid, by four distances as far away as half a pixel.
vec3 krs_normal_at(vec3 p, float reach)
{
    vec3  sum = vec3(0.0);
    float way = @normal_reach@;
    for (int i = 0; i < 4; i++) {
        vec3 corner = vec3(i == 0 || i == 3 ? 1.0 : -1.0, i == 1 || i == 3 ? 1.0 : -1.0, i == 2 || i == 3 ? 1.0 : -1.0);
        sum += corner * krs_distance(p + 0.57735 * way * corner);
    }
    return normalize(sum);
}
