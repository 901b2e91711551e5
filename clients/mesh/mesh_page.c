#include "mesh_report.h"

#include "page.h"

#include <stdio.h>

static void add_meshes(struct page *page, const struct mesh_report *report)
{
    for (int m = 0; m < 2; m++) {
        const struct mesh *mesh = report->mesh[m];
        char note[600];
        page_mesh(page, &(struct page_mesh){.name = report->name[m],
                                            .vertex_count = mesh->vertex_count,
                                            .face_count = mesh->face_count,
                                            .vertex = mesh->vertex,
                                            .face = mesh->face,
                                            .verdict = report->intersection->worst[m],
                                            .velocity = report->query->velocity[m]});
        snprintf(note, sizeof note, "%c %.400s: %zu of %zu faces meet", 'A' + m, report->name[m],
                 report->intersection->faces[m], mesh->face_count);
        page_note(page, note);
    }
}

static void note_counts(struct page *page, const struct mesh_intersection *found)
{
    char note[200];
    snprintf(note, sizeof note, "%zu pairs of faces meet: %zu overlap, %zu touch", found->count,
             found->overlapping, found->touching);
    page_note(page, note);
}

void mesh_page_write(FILE *out, const struct mesh_report *report)
{
    const struct mesh_intersection *found = report->intersection;
    char title[1000];
    snprintf(title, sizeof title, "%.400s and %.400s", report->name[0], report->name[1]);
    struct page *page = page_open(&(struct page_options){
        .kind = PAGE_MESH, .title = title, .pairs_max = MESH_PAGE_PAIRS_MAX});
    page_step_begin(page,
                    &(struct page_step){.duration = found->moving ? report->query->duration : 0});
    add_meshes(page, report);
    note_counts(page, found);
    for (size_t i = 0; i < found->count; i++) {
        const struct mesh_pair *pair = &found->pair[i];
        const struct fmb_client_answer answer = {
            .a = pair->a,
            .b = pair->b,
            .answer = {.verdict = pair->verdict,
                       .has_contact = found->moving,
                       .contact = {pair->contact[0], pair->contact[1]}}};
        page_pair(page, 3, NULL, &answer);
    }
    page_step_end(page);
    page_write(page, out);
    page_close(page);
}
