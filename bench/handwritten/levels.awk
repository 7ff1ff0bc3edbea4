# levels.awk: prints the lines of literal numbers that the hand-written shaders consist of.
#
#     awk -v tree=28 -f levels.awk      the levels of ../scenes/tree.krs
#     awk -v grove=7 -f levels.awk      the upright mirrors of ../scenes/forest.krs
#     awk -v terrain=28 -f levels.awk   the mirrors of ../scenes/terrain.krs
#
# An author would print them once and paste them into the shader; so it was done here.

function number(x,   s) { s = sprintf("%.7g", x); return s ~ /[.e]/ ? s : s ".0" }
function vector(x, y, z) { return "vec3(" number(x) ", " number(y) ", " number(z) ")" }
function bend(i) { return (i == 0 ? 5 : 14) * degree }
function reach(i) { return i == 0 ? 0.7 : 0.72 ^ i }
function width(i) { return i == 0 ? 0.066 : 0.075 * 0.75 ^ i }
function mirror(nx, ny, nz, w) { return "FOLD(" vector(nx, ny, nz) ", " number(w) ")" }

# The arc from P along T, bending to S: its circle's plane has the axes X along the chord and Y
# from the centre to the middle of the arc.
function limb(i,   r, c, s, k) {
    r = reach(i) / (2 * sin(bend(i)))
    c = cos(bend(i)); s = sin(bend(i))
    for (k = 0; k < 3; k++) {
        X[k] = c * T[k] + s * S[k]
        Y[k] = s * T[k] - c * S[k]
        C[k] = P[k] + r * S[k]
    }
    Z[0] = X[1] * Y[2] - X[2] * Y[1]
    Z[1] = X[2] * Y[0] - X[0] * Y[2]
    Z[2] = X[0] * Y[1] - X[1] * Y[0]
    return "LIMB(" vector(X[0], X[1], X[2]) ", " vector(Y[0], Y[1], Y[2]) ",\n         " \
        vector(Z[0], Z[1], Z[2]) ", " vector(along(X), along(Y), along(Z)) ",\n         vec2(" \
        number(s) ", " number(c) "), " number(r) ", " number(width(i)) ")"
}

function along(axis) { return C[0] * axis[0] + C[1] * axis[1] + C[2] * axis[2] }

# From the beginning of branch i to that of the next one.
function climb(i,   k, c, s, left) {
    c = cos(bend(i)); s = sin(bend(i))
    for (k = 0; k < 3; k++)
        P[k] += reach(i) * (c * T[k] + s * S[k])
    c = cos(2 * bend(i)); s = sin(2 * bend(i))
    for (k = 0; k < 3; k++) {
        left = c * S[k] - s * T[k]
        T[k] = c * T[k] + s * S[k]
        S[k] = left
    }
    Z[0] = T[1] * S[2] - T[2] * S[1]
    Z[1] = T[2] * S[0] - T[0] * S[2]
    Z[2] = T[0] * S[1] - T[1] * S[0]
    for (k = 0; k < 3; k++)
        S[k] = cos(turn) * S[k] + sin(turn) * Z[k]
}

function fork(   k, w) {
    for (k = 0; k < 3; k++) {
        N[k] = -sin(tilt) * T[k] - cos(tilt) * S[k]
        w += N[k] * P[k]
    }
    return mirror(N[0], N[1], N[2], w)
}

function share(i, step) { return step * i - int(step * i) }

BEGIN {
    degree = atan2(0, -1) / 180
    turn = 100 * degree
    tilt = 9 * degree
    T[0] = -sin(5 * degree); T[1] = cos(5 * degree)
    S[0] = cos(5 * degree); S[1] = sin(5 * degree)
    P[0] = P[1] = P[2] = T[2] = S[2] = 0
    for (i = 0; i < tree; i++) {
        if (i > 0)
            print "    " fork()
        print "    " limb(i)
        climb(i)
    }
    for (i = grove - 1; i >= 0; i--)
        print "    " mirror(cos(75 * i * degree), 0, sin(75 * i * degree), 1.4 * 1.42 ^ i)
    for (i = 0; i < terrain; i++) {
        lean = i < 4 ? 4 : (share(i, 0.332) < 0.5 ? 1 : -1) * (3 + 7 * share(i, 0.362))
        flat = cos(lean * degree)
        print "    " mirror(flat * cos(137.5 * i * degree), sin(lean * degree), \
                            flat * sin(137.5 * i * degree), 6 * 0.86 ^ i * share(i, 0.283))
    }
}
