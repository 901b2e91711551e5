/* ODE: dBoxBox(), of boxes. */
#include <ode/ode.h>

#include <cmath>

#include "bodies.hh"

namespace
{

struct Box {
    dVector3 centre, size;
    dMatrix3 rotation;
};

Box box_of(const peer_solid &solid)
{
    Box out = {};
    for (int i = 0; i < 3; i++) {
        out.centre[i] = solid.centre[i];
        out.size[i] = solid.size[i];
        for (int axis = 0; axis < 3; axis++)
            out.rotation[4 * axis + i] = solid.axis[i][axis];
    }
    return out;
}

double gap(void *bodies, size_t a, size_t b)
{
    const Box &p = body_at<Box>(bodies, a), &q = body_at<Box>(bodies, b);
    dContactGeom contact;
    dVector3 normal;
    dReal depth;
    int code;
    const int contacts = dBoxBox(p.centre, p.rotation, p.size, q.centre, q.rotation, q.size, normal,
                                 &depth, &code, 1, &contact, sizeof contact);
    return contacts > 0 ? -INFINITY : INFINITY;
}

const peer methods[] = {{"ode", PEER_VERDICT, PEER_3D | PEER_BOXES, gap}};

}  // namespace

const peer_library peer_library_ode = {methods, sizeof methods / sizeof *methods,
                                       "ode: dBoxBox() with one contact, of boxes.",
                                       bodies_open<Box, box_of>, bodies_close<Box>};
