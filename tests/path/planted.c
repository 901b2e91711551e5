/* fmb path with bounds that are too small: path-planted FACTOR speed|curve ARGUMENTS OF FMB PATH.
 * What it proves is wrong, and fmb-check-path has to reject it. */
#include "commands.h"
#include "path.h"

#include <stdlib.h>
#include <string.h>

static double speed_factor = 1, curve_factor = 1;

void __real_path_bounds_of(struct fmb_robot_path *path, const struct path_chain *chain, unsigned a,
                           unsigned b, struct path_bounds *out);
void __wrap_path_bounds_of(struct fmb_robot_path *path, const struct path_chain *chain, unsigned a,
                           unsigned b, struct path_bounds *out);
void __wrap_path_bounds_of(struct fmb_robot_path *path, const struct path_chain *chain, unsigned a,
                           unsigned b, struct path_bounds *out)
{
    __real_path_bounds_of(path, chain, a, b, out);
    out->speed *= speed_factor;
    for (int i = 0; i < 3; i++)
        out->curve[i] *= curve_factor;
}

int main(int argc, char **argv)
{
    if (argc < 3)
        return 2;
    *(strcmp(argv[2], "speed") == 0 ? &speed_factor : &curve_factor) = strtod(argv[1], NULL);
    argv[2] = (char[]){"path"};
    return cmd_path(argc - 2, argv + 2);
}
