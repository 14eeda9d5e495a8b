#include "analysis/report/facts.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

void fact_device(const struct sample_session *s, char out[FACT])
{
    snprintf(out, FACT, "%s", s->device);
}

void fact_driver(const struct sample_session *s, char out[FACT])
{
    snprintf(out, FACT, "%s", s->driver);
}

void fact_display(const struct sample_session *s, char out[FACT])
{
    snprintf(out, FACT, "%s", s->display);
}

void fact_rate(const struct sample_session *s, char out[FACT])
{
    if (!isnan(s->refresh_hz))
        snprintf(out, FACT, "%g Hz, %s clock", s->refresh_hz, s->simulated_clock ? "simulated" : "real");
    else
        snprintf(out, FACT, "%s", s->simulated_clock ? "simulated clock" : "");
}

void fact_size(const struct sample_session *s, char out[FACT])
{
    out[0] = '\0';
    if (!isnan(s->width_px) && !isnan(s->height_px))
        snprintf(out, FACT, "%g \u00d7 %g px per eye", s->width_px, s->height_px);
}

void fact_fov(const struct sample_session *s, char out[FACT])
{
    out[0] = '\0';
    if (!isnan(s->fov_deg))
        snprintf(out, FACT, "%g\u00b0 vertical", s->fov_deg);
}

void fact_seed(const struct sample_session *s, char out[FACT])
{
    snprintf(out, FACT, "%" PRIu64, s->seed);
}

void fact_version(const struct sample_session *s, char out[FACT])
{
    snprintf(out, FACT, "%s", s->app_version);
}

void fact_scenes(const struct sample_session *s, char out[FACT])
{
    snprintf(out, FACT, "%s", s->scenes);
}

void fact_observer(const struct sample_session *s, char out[FACT])
{
    snprintf(out, FACT, "%s", s->observer);
}

void fact_protocol(const struct sample_session *s, char out[FACT])
{
    snprintf(out, FACT, "%s, SHA-256 %s", s->protocol_name, s->protocol_sha256);
}

void fact_status(const struct sample_session *s, char out[FACT])
{
    snprintf(out, FACT, "%s", s->status);
}

bool facts_differing(const struct sample *sample, char *out, size_t out_size)
{
    static const struct {
        const char *name;
        fact_fn fact;
        bool drawn;
    } facts[] = {
        {"protocol text", fact_protocol, false}, {"scenes", fact_scenes, false}, {"size", fact_size, true},
        {"field of view", fact_fov, true},       {"rate", fact_rate, true},      {"device", fact_device, true}};
    char first[FACT], value[FACT];
    out[0] = '\0';
    for (size_t k = 0; k < sizeof facts / sizeof facts[0]; k++) {
        bool known = false, differs = false;
        for (size_t i = 0; i < sample->session_count; i++) {
            const struct sample_session *s = &sample->sessions[i];
            if (s->excluded || (facts[k].drawn && !s->device[0])) // nothing was drawn without a device
                continue;
            facts[k].fact(s, known ? value : first);
            differs = differs || (known && strcmp(first, value) != 0);
            known = true;
        }
        if (differs)
            snprintf(out + strlen(out), out_size - strlen(out), "%s%s", out[0] ? ", " : "", facts[k].name);
    }
    return out[0] != '\0';
}
