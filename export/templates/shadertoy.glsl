// @name@, for the tab Image of Shadertoy.  Made by krs @version@ of a scene of implicit surfaces.
//
// Drag the mouse to turn.  These numbers are the scene's parameters:
@constant_parameters@
@constants@
vec4 krs_parameter[@slots@];

@scene@
@tracer@
void krs_set_parameters()
{
    krs_parameter[0] = vec4(iTime, 0.0, 0.0, 0.0);
@set_parameters@}

void mainImage(out vec4 color, in vec2 at)
{
    krs_set_parameters();
    krs_prepare();
    float turn = iMouse.z > 0.0 ? 6.2831853 * (iMouse.x / iResolution.x - 0.5) : 0.0;
    vec3  eye = KRS_EYE - KRS_TARGET;
    eye = KRS_TARGET + vec3(cos(turn) * eye.x + sin(turn) * eye.z, eye.y, cos(turn) * eye.z - sin(turn) * eye.x);
    vec3  ahead = normalize(KRS_TARGET - eye), right = normalize(cross(ahead, KRS_UP)), up = cross(right, ahead);
    vec2  plane = (2.0 * at - iResolution.xy) / iResolution.y * KRS_RISE;
    vec3  direction = normalize(ahead + plane.x * right + plane.y * up);
    float pixel = 2.0 * KRS_RISE / iResolution.y, t;
    vec3  light = krs_trace(eye, direction, 0.0, KRS_FARTHEST, pixel, t) ? krs_shade(eye, direction, t, pixel)
                                                                        : krs_sky(direction);
    color = vec4(krs_display(light), 1.0);
}
