// Where a trial's target was, and how far the gaze is from it.
#include "analysis/report/gaze_private.h"

#include <math.h>
#include <stdlib.h>

// A target stays where its frame had it until the next frame; a display slower than 10 Hz shows no target.
#define TARGET_NS 100000000

struct gaze_place {
    int64_t segment_id, shown_ns;
    double x_deg, y_deg, distance_m; // from the middle between the eyes; distance NaN: not known
};

static bool add_place(void *user, const struct store_target_row *row)
{
    struct gaze_places *places = user;
    if (!isfinite(row->x_deg) || !isfinite(row->y_deg))
        return true;
    if (!sample_grow(&places->all, places->count, sizeof places->all[0]))
        return !(places->no_memory = true);
    places->all[places->count++] =
        (struct gaze_place){row->segment_id, row->shown_ns, row->x_deg, row->y_deg, row->distance_m};
    return true;
}

bool gaze_places_read(struct gaze_places *places, struct store_reader *reader, int64_t trial_id)
{
    places->count = places->at = 0;
    return store_read_targets(reader, trial_id, add_place, places);
}

void gaze_places_finish(struct gaze_places *places)
{
    free(places->all);
    *places = (struct gaze_places){.all = NULL};
}

static const struct gaze_place *place_at(struct gaze_places *p, const struct store_gaze_sample *row)
{
    while (p->at > 0 && p->all[p->at - 1].shown_ns > row->host_ns)
        p->at--;
    while (p->at < p->count &&
           (p->all[p->at].segment_id != row->segment_id || p->all[p->at].shown_ns <= row->host_ns))
        p->at++;
    const struct gaze_place *last = p->at ? &p->all[p->at - 1] : NULL;
    bool known = last && last->segment_id == row->segment_id && row->host_ns - last->shown_ns <= TARGET_NS;
    return known ? last : NULL;
}

// Where the sample's eye sees the target; NaN where that is not known. One direction for both eyes is from the
// middle between them.
static struct gaze_point seen(const struct gaze_place *place, char eye, double ipd_m)
{
    struct gaze_point from_middle = gaze_point(0, place->x_deg, place->y_deg);
    if (eye == 'b')
        return from_middle;
    bool known = place->distance_m > 0 && isfinite(place->distance_m) && ipd_m >= 0 && isfinite(ipd_m);
    return gaze_point_from_eye(&from_middle, known ? place->distance_m : (double)NAN,
                               eye == 'l' ? -ipd_m / 2 : ipd_m / 2);
}

void gaze_compare(struct gaze_places *places, const struct gaze_options *options, double ipd_m,
                  const struct store_gaze_sample *row, struct gaze_target *target)
{
    const struct gaze_place *place = place_at(places, row);
    if (!place) {
        target->unknown++;
        return;
    }
    struct gaze_point gaze = gaze_point(0, row->x_deg, row->y_deg), at = seen(place, row->eye, ipd_m);
    if (!isfinite(at.x_deg)) {
        target->flat++;
        return;
    }
    double distance = gaze_angle_deg(&gaze, &at);
    gaze_spread_add(&target->offset, (row->x_deg - at.x_deg) * cos(at.y_deg * M_PI / 180),
                    row->y_deg - at.y_deg);
    gaze_running_add(&target->error, distance);
    if (fabs(row->x_deg) > options->region_x_deg || fabs(row->y_deg) > options->region_y_deg) {
        target->outside++;
        return;
    }
    target->samples++;
    gaze_running_add(&target->distance, distance);
    gaze_bins_add(&target->distances, distance);
}
