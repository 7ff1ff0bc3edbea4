// The room of room.krs.  Here z points the other way, and light is not divided by pi where it is
// scattered.
#version 3.7;
global_settings {
    assumed_gamma 1.0
    max_trace_level 12
    radiosity {
        pretrace_start 0.08
        pretrace_end 0.01
        count 200
        nearest_count 10
        error_bound 0.4
        low_error_factor 0.5
        recursion_limit 4
        gray_threshold 0
        minimum_reuse 0.003
        brightness 1
    }
}
#default { finish { ambient 0 diffuse 1 } }
#declare White = texture { pigment { rgb 0.7 } };
#declare Red = texture { pigment { rgb <0.6, 0.08, 0.08> } };
#declare Green = texture { pigment { rgb <0.1, 0.45, 0.1> } };
camera {
    location <0, 0, -4.4>
    right x * image_width / image_height
    up y
    direction z / (2 * tan(radians(19)))
    look_at 0
}
#declare Near = 0.01;
light_source {
    <0, 0.7, 0> rgb 0.3 / pi / (2 * Near * Near)
    area_light x * 0.3, y * 0.3, 5, 5 circular orient jitter
    fade_distance Near fade_power 2
}
#macro Block(Size, Turn, Place, Paint)
    box { -Size / 2, Size / 2 texture { Paint } rotate y * Turn translate Place }
#end
Block(<2.2, 0.1, 2.2>, 0, <0, -1.05, 0>, White)
Block(<2.2, 0.1, 2.2>, 0, <0, 1.05, 0>, White)
Block(<2.2, 2.2, 0.1>, 0, <0, 0, 1.05>, White)
Block(<0.1, 2.2, 2.2>, 0, <-1.05, 0, 0>, Red)
Block(<0.1, 2.2, 2.2>, 0, <1.05, 0, 0>, Green)
Block(<0.6, 1.2, 0.6>, -18, <-0.35, -0.4, 0.3>, White)
Block(<0.6, 0.6, 0.6>, 17, <0.4, -0.7, -0.35>, White)
