#include "query_page.h"

#include "allocate.h"

#include <stdlib.h>

static void add_body(struct page *page, const struct fmb_placement *placement,
                     struct page_frames *frames)
{
    const struct fmb_body *body = placement->body;
    for (unsigned i = 0; i < body->frame_count; i++) {
        const struct fmb_frame *frame = fmb_body_frame(body, i);
        bool by_vertices;
        const size_t count = fmb_frame_numbers(frame, &by_vertices, NULL);
        double *number = allocate(count, sizeof *number);
        fmb_frame_numbers(frame, &by_vertices, number);
        page_frames_add(frames, (int) frame->shape, by_vertices, number, count);
        free(number);
    }
    page_body(page,
              &(struct page_body){
                  .id = placement->id,
                  .name = placement->name,
                  .dim = body->dim,
                  .frames = frames,
                  .position = placement->position,
                  .velocity = placement->velocity,
                  .orientation = placement->orientation_count ? placement->orientation : NULL});
    frames->count = 0;
}

static void begin(struct report *report)
{
    struct query_page *query = (struct query_page *) report;
    const struct fmb_scene *scene = &report->scene->scene;
    struct page_frames frames = {NULL, 0, 0};
    page_step_begin(query->page, &(struct page_step){.time = query->end,
                                                     .duration = scene->duration,
                                                     .margin = scene->margin,
                                                     .label = scene->label});
    for (size_t i = 0; i < scene->placement_count; i++)
        add_body(query->page, &scene->placements[i], &frames);
    free(frames.number);
    query->end += scene->duration;
}

static void pair(struct report *report, const struct fmb_client_answer *answer)
{
    const struct query_page *query = (struct query_page *) report;
    const struct page_answer now = {
        .answer = &answer->answer,
        .error = answer->status == FMB_OK ? NULL : fmb_status_text((int) answer->status)};
    page_pair(query->page, answer->a, answer->b, report->scene->dim, NULL, &now);
}

static void end(struct report *report)
{
    page_step_end(((struct query_page *) report)->page);
}

struct query_page query_page_open(const char *title)
{
    const struct page_options options = {.kind = PAGE_SCENES, .title = title};
    return (struct query_page){.report = {.begin = begin, .pair = pair, .end = end},
                               .page = page_open(&options)};
}
