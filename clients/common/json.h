/* Reads scenes from JSON text. Text that is not a scene in every detail is refused, with one line
 * that names the place. The form:
 *
 *     {"dim": 3, "duration": 1.0, "margin": 0.001,
 *      "bodies": [{"id": 1, "name": "table", "shape": "box", "size": [2,1,0.25],
 *                  "position": [0,0,0.125]},
 *                 {"id": 2, "position": [0.5,0,0.5], "orientation": [0.9239,0,0,0.3827],
 *                  "velocity": [0,0,-0.1],
 *                  "frames": [{"shape": "box", "size": [0.1,0.1,0.2], "position": [0,0,0.1]},
 *                             {"shape": "tetrahedron", "origin": [0,0,0],
 *                              "components": [[1,0,0],[0,1,0],[0,0,1]]}]},
 *                 {"id": 3, "shape": "cuboid", "origin": [0,0,0],
 *                  "components": [[1,0,0],[0,1,0],[0,0,1]]}],
 *      "ignore": [[1,3]]}
 *
 * "vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]] may stand in place of origin and components of a
 * tetrahedron (dim + 1 vertices) or face (3). A body may have "group": an integer other than 0, of
 * magnitude up to 2^53 - 1; bodies of one group are never tested against each other. A scene may
 * have "label", which is for people, like the names of bodies.
 *
 * Each frame may have "radius", 0 or more: it is then the set of points within that distance of the
 * shape. A box, for example, extends beyond its size by the radius on every side. There are three
 * more shapes, centred at 0: a sphere, with "radius"; a capsule, with "radius" and the "length" of
 * its core along the last axis; and in 3D a cylinder about z, with "radius" and "length". A
 * cylinder is read as a hull that contains it (enclosure.h), with "sides" (default 16).
 *
 * dim (2 or 3) and bodies are required, and each body's id. A body has frames, or is one frame
 * itself. A frame is a box of full size, or has components. All numbers are read as doubles, ids
 * too: 1e0 is the id 1. An integer beyond 2^53 - 1 is no id, since several texts read as the same
 * double. Keys may come in any order, each at most once. The values of missing keys:
 *
 * - duration: 1. margin: 0.
 * - pairs: all except those to ignore and those within a group, in body order.
 * - position and origin: 0. (A body that is one frame of components needs one of position,
 *   orientation and origin; one of vertices does not.)
 * - orientation: not turned. velocity: at rest.
 * - position and orientation of end: the position and orientation of the body.
 *
 * origin of a body that is one frame is its position, unless it has position or orientation too;
 * then, as in frames, it is in body coordinates. In frames, only boxes, capsules and cylinders have
 * a position and an orientation, spheres a position: the pose of the shape in its body. A box that
 * is turned there becomes a cuboid, whose numbers are rounded (turned_box.h), as are those of a
 * capsule that is moved or turned. In 3D, "orientation_xyzw": [x,y,z,w] may stand in place of
 * orientation. In pairs and ignore, the name of a body may stand in place of its id, unless another
 * body has the same name.
 *
 * "end": {"position": [0,0,1], "orientation": [1,0,0,1]}, in place of velocity, is the pose of a
 * body at the end of the window. The duration then must not be 0. fmb.h defines the motion.
 *
 * An input holds one or more such objects, one after the other. */
#ifndef JSON_H
#define JSON_H

#include "scene.h"

struct json_reader;

/* Returns a reader of an open file, from its current position; the file is not owned. Exits with
 * status 1 if memory is exhausted. */
struct json_reader *json_open(int fd);
void json_close(struct json_reader *reader);

enum json_outcome {
    JSON_SCENE, /* *out, to be cleared by the caller */
    JSON_END,   /* no more objects, after one at least */
    JSON_BAD,   /* the text is not a scene: json_error() */
    JSON_FAILED /* the file cannot be read: json_error() */
};

/* Reads the next scene. Returns as soon as its object is complete, without waiting for more input.
 * After any outcome but JSON_SCENE there is no next call.
 *
 * The text gives neither method nor want: the caller sets both. A body that exceeds
 * FMB_CLIENT_BODY_BYTES_MAX is refused whether or not the bus is used. */
enum json_outcome json_next(struct json_reader *reader, struct owned_scene *out);

/* For programs: ends the process with status 1 if the parser runs out of memory. Without this call,
 * that looks like invalid JSON. Changes cJSON for the whole process. */
void json_exit_without_memory(void);

/* Accepts "link" in bodies of the following scenes: the link of a robot that carries the body. */
void json_allow_links(struct json_reader *reader);

/* After JSON_BAD and JSON_FAILED: returns the reason, one line without a line feed, valid as long
 * as the reader:
 *
 *     bodies[3].components[1]: expected 3 numbers, found 2
 *     line 3, column 14: invalid JSON
 *
 * From the second object of the input on it begins with "scene 2: ". */
const char *json_error(const struct json_reader *reader);

#endif
