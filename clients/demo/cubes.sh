#!/bin/sh
# A scene of 96 cubes at rest on a table, as programs compute it: each is turned by up to 3 quarter
# turns about x and then by any yaw, with sin() and cos(), and stands as high above the table as its
# lowest corner then is. Everything rounds, so that each cube overlaps the table by some 1e-17,
# touches it, or is as little above it.
awk 'function abs(x) {
    return x < 0 ? -x : x
}
BEGIN {
    pi = atan2(0, -1)
    print "{\"dim\": 3, \"margin\": 1e-9,"
    printf " \"bodies\": [{\"id\": 97, \"name\": \"table\", \"shape\": \"box\", \"size\": [24,16,1], \"position\": [0,0,-0.5]}"
    for (i = 0; i < 96; i++) {
        roll = i % 4 * pi / 4
        yaw = i * pi / 96
        w = cos(yaw) * cos(roll)
        x = cos(yaw) * sin(roll)
        y = sin(yaw) * sin(roll)
        z = sin(yaw) * cos(roll)
        height = (abs(2 * (x * z - w * y)) + abs(2 * (y * z + w * x)) + abs(w * w - x * x - y * y + z * z)) / 2
        printf ",\n            {\"id\": %d, \"shape\": \"box\", \"size\": [1,1,1], \"position\": [%d,%d,%.17g],\n",
            i + 1, i % 12 * 2 - 11, int(i / 12) * 2 - 7, height
        printf "             \"orientation\": [%.17g,%.17g,%.17g,%.17g]}", w, x, y, z
    }
    print "]}"
}'
