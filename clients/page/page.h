/* Writes an HTML page that plays scenes: one file that fetches nothing. Its data is JSON,
 * compressed: a list of steps. A step is one query: its scene and the answers to pairs of it, in
 * the form of scene_json.h and report.h.
 *
 *     struct page *page = page_open(&options);
 *     page_step_begin(page, &step);      // for each step, in any order of time:
 *     page_body(page, &placement, NULL); // each body, in the order of the indices of the pairs
 *     page_pair(page, ...);              // each pair that has an answer
 *     page_step_end(page);
 *     page_write(page, out);
 *
 * page_exchange.h does this for the queries of a log, page_scene_begin() for the bodies of a scene.
 * Shapes are written once. Numbers of answers have nine digits, and all digits where two answers
 * differ; poses have all. All texts may be any bytes.
 *
 * All functions exit with status 1 if memory is exhausted. For one thread at a time. */
#ifndef PAGE_H
#define PAGE_H

#include "fmb_client.h"
#include "json_write.h"
#include "output.h"

#include <stdio.h>

/* A page stays below PAGE_BYTES_MAX, its own text of about a megabyte included. All other limits
 * count bytes before compression, which leaves less than half of them. Steps are kept as a whole up
 * to PAGE_STEPS_BYTES, steps that differ up to PAGE_DIFFERENT_BYTES more. Separated pairs without a
 * gap within the margin are kept up to PAGE_FAR_BYTES in all. Of a step PAGE_PAIRS_MAX pairs that
 * differ are kept, as many in contact or near, and as many others. The page says what was left out.
 * At most PAGE_FRAME_PAIRS_MAX pairs of frames are decided, which takes about a second. Beyond this
 * limit, whole bodies are drawn as in contact. */
enum {
    PAGE_BYTES_MAX = 40 << 20,
    PAGE_STEPS_BYTES = 64 << 20,
    PAGE_DIFFERENT_BYTES = 5 << 20,
    PAGE_FAR_BYTES = 5 << 20,
    PAGE_PAIRS_MAX = 1000,
    PAGE_FRAME_PAIRS_MAX = 1 << 18
};

enum page_kind { PAGE_SCENES, PAGE_REPLAY };

struct page_options {
    enum page_kind kind;
    const char *title;
    const char *sides[2]; /* what the answers then and now are; NULL: there is one side */
};

/* Copies what options point to. Returns a page, never NULL. */
struct page *page_open(const struct page_options *options);
void page_close(struct page *page); /* may be NULL */

/* ---- Steps ---- */

struct page_step {
    double time;       /* of the begin of the window, seconds since the begin of the page */
    double duration;   /* of the window, seconds */
    double margin;     /* 0: none */
    const char *label; /* NULL or "": none */
    bool differs;      /* the answers then and now differ */
    /* The bodies exist until page_step_end(), so that the frames in contact can be determined. */
    bool bodies_remain;
};

/* Returns a writer for further members of the step, valid until the first body is added. Returns
 * NULL if the page keeps no more steps; the other functions then have no effect. */
struct json_writer *page_step_begin(struct page *page, const struct page_step *step);

/* Adds a body. missing: NULL; or why the body cannot be drawn: then only id and name are read. */
void page_body(struct page *page, const struct fmb_placement *placement, const char *missing);

/* Adds the answer to a pair. a and b of the answer are indices of bodies.
 * then: the earlier answer, or NULL if it is the same as now. */
void page_pair(struct page *page, int dim, const struct fmb_client_answer *then,
               const struct fmb_client_answer *now);

void page_step_end(struct page *page);

/* Begins a step with the bodies of a scene. The windows of the scenes follow each other. */
void page_scene_begin(struct page *page, const struct fmb_scene *scene);

/* ---- Writing ---- */

/* Call it once. On output: ferror(out) is set if writing failed. */
void page_write(struct page *page, FILE *out);

/* As page_write(), to a file if one is wanted. Returns false after an error, which was reported. */
bool page_save(struct page *page, const struct output_options *options);

#endif
