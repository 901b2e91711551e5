#include "wrong_bounds.h"

#include "path.h"

double wrong_speed = 1, wrong_curve = 1;

void __real_path_bounds_of(struct fmb_robot_path *path, const struct path_chain *chain, unsigned a,
                           unsigned b, struct path_bounds *out);
void __wrap_path_bounds_of(struct fmb_robot_path *path, const struct path_chain *chain, unsigned a,
                           unsigned b, struct path_bounds *out);
void __wrap_path_bounds_of(struct fmb_robot_path *path, const struct path_chain *chain, unsigned a,
                           unsigned b, struct path_bounds *out)
{
    __real_path_bounds_of(path, chain, a, b, out);
    out->speed *= wrong_speed;
    for (int i = 0; i < 3; i++)
        out->curve[i] *= wrong_curve;
}
