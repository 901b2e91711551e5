/* The names of the numbers in fmb.h. A separate object in both libfmb and libfmb-client, so that a
 * program can link either or both. */
#include "fmb.h"

const char *fmb_status_text(int status)
{
    switch (status) {
#define X(name, number, text) \
    case number: return text;
        FMB_STATUS_MAP(X)
#undef X
    }
    return "unknown status";
}

const char *fmb_shape_name(int shape)
{
    switch (shape) {
    case FMB_CUBOID: return "cuboid";
    case FMB_TETRAHEDRON: return "tetrahedron";
    case FMB_FACE: return "face";
    case FMB_BOX: return "box";
    case FMB_HULL: return "hull";
    }
    return NULL;
}

int fmb_component_count(int dim, int shape)
{
    bool known_dim = dim == 2 || dim == 3;
    switch (shape) {
    case FMB_CUBOID:
    case FMB_BOX:
    case FMB_TETRAHEDRON: return known_dim ? dim : 0;
    case FMB_FACE: return dim == 3 ? 2 : 0;
    }
    return 0;
}

const char *fmb_verdict_name(int verdict)
{
    switch (verdict) {
    case FMB_SEPARATED: return "separated";
    case FMB_TOUCHING: return "touching";
    case FMB_OVERLAPPING: return "overlapping";
    }
    return NULL;
}

#define TEXT(x) #x
#define VERSION(major, minor, patch) TEXT(major) "." TEXT(minor) "." TEXT(patch)

const char *fmb_version(void)
{
    return VERSION(FMB_VERSION_MAJOR, FMB_VERSION_MINOR, FMB_VERSION_PATCH);
}
