#include "app/gaze/fovea.h"

#include <math.h>

void fovea_sample(struct fovea *fovea, const struct gaze_sample *sample, int64_t sample_id)
{
    if (!sample->valid || !isfinite(sample->x_deg) || !isfinite(sample->y_deg))
        return;
    for (int eye = 0; eye < EYES; eye++) {
        if (sample->eye != GAZE_BOTH && sample->eye != (eye == EYE_LEFT ? GAZE_LEFT : GAZE_RIGHT))
            continue;
        fovea->eyes[eye].known = true;
        fovea->eyes[eye].x_deg = sample->x_deg;
        fovea->eyes[eye].y_deg = sample->y_deg;
        fovea->eyes[eye].host_ns = sample->host_ns;
        fovea->eyes[eye].sample_id = sample_id;
    }
}

// An eye that was never seen looks where the other one does.
void fovea_at(const struct fovea *fovea, int64_t now_ns, struct fovea_use *out)
{
    *out = (struct fovea_use){.x_deg = {NAN, NAN}, .y_deg = {NAN, NAN}, .lost = true};
    int64_t newest_ns = INT64_MIN;
    for (int eye = 0; eye < EYES; eye++) {
        int from = fovea->eyes[eye].known ? eye : 1 - eye;
        if (!fovea->eyes[from].known)
            return;
        out->x_deg[eye] = fovea->eyes[from].x_deg;
        out->y_deg[eye] = fovea->eyes[from].y_deg;
        if (fovea->eyes[from].host_ns > newest_ns) {
            newest_ns = fovea->eyes[from].host_ns;
            out->sample_id = fovea->eyes[from].sample_id;
        }
    }
    out->known = true;
    out->age_ns = now_ns - newest_ns;
    out->lost = out->age_ns > FOVEA_HOLD_NS;
}

void fovea_on(struct dvec3 point, double ipd_m, struct fovea_use *out)
{
    const struct pose head = {.orientation = {0, 0, 0, 1}};
    *out = (struct fovea_use){.known = false};
    for (int eye = 0; eye < EYES; eye++)
        viewing_angles(dvec3_sub(point, viewing_eye_pose(&head, eye, ipd_m).position), &out->x_deg[eye],
                       &out->y_deg[eye]);
}

bool fovea_returned(bool *was_lost, const struct fovea_use *use)
{
    const bool returned = *was_lost && !use->lost;
    *was_lost = use->lost;
    return returned;
}
