# compare.awk: a row of the table of compare.sh, from the runs of a scene.

# Median of the numbers of a kind and a build.
function median(key,    n, list, i, k, v) {
    n = split(values[key], list, " ")
    for (i = 2; i <= n; i++)
        for (k = i; k > 1 && list[k - 1] + 0 > list[k] + 0; k--) {
            v = list[k]; list[k] = list[k - 1]; list[k - 1] = v
        }
    return n % 2 ? list[(n + 1) / 2] : (list[n / 2] + list[n / 2 + 1]) / 2
}

# "KIND BUILD NUMBER...": the numbers are added up.
{
    sum = 0
    for (i = 3; i <= NF; i++) sum += $i
    values[$1, $2] = values[$1, $2] " " sum
}

END {
    printf "| %s |", scene
    split("sum total wall front JIT start", kinds, " ")
    for (i = 1; i <= 6; i++) {
        a = median(kinds[i] SUBSEP "before"); b = median(kinds[i] SUBSEP "after")
        printf " %.1f %.1f %.2f |", a, b, (a > 0 ? b / a : 0)
    }
    print ""
}
