#include "query_page.h"

static void begin(struct report *report)
{
    struct query_page *query = (struct query_page *) report;
    const struct fmb_scene *scene = &report->scene->scene;
    page_step_begin(query->page, &(struct page_step){.time = query->end,
                                                     .duration = scene->duration,
                                                     .margin = scene->margin,
                                                     .label = scene->label});
    for (size_t i = 0; i < scene->placement_count; i++)
        page_body(query->page, &scene->placements[i], NULL);
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
