# Prints `scenes` scenes of 30 boxes that move in a room of 4 x 4 x 2.
# Use: awk -v scenes=10000 -f many.awk

BEGIN {
    pi = atan2(0, -1)
    for (i = 0; i < scenes; i++) {
        printf "{\"dim\":3,\"duration\":0.01,\"margin\":0.05,\"bodies\":["
        for (k = 1; k <= 30; k++) {
            t = i * 0.01 * (1 + k % 5) / 3 + k
            printf "%s{\"id\":%d,\"name\":\"part %d\",\"shape\":\"box\",\"size\":[%g,%g,%g],", (k > 1 ? "," : ""), k, k, \
                0.2 + k % 3 * 0.1, 0.2 + k % 4 * 0.1, 0.2 + k % 5 * 0.05
            printf "\"position\":[%.9f,%.9f,%.9f],", 2 * sin(t + k), 2 * cos(0.7 * t + 2 * k), sin(1.3 * t + 3 * k)
            printf "\"orientation\":[%.9f,%.9f,0.2,%.9f],", cos(t), sin(t), sin(2 * t)
            printf "\"velocity\":[%.9f,%.9f,%.9f]}", cos(t + k), -sin(0.7 * t + 2 * k), cos(1.3 * t + 3 * k)
        }
        print "]}"
    }
}
