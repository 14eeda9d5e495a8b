// What is known of a session beside its answers, as text for a reader: "" where it was not recorded.
#ifndef ANALYSIS_REPORT_FACTS_H
#define ANALYSIS_REPORT_FACTS_H

#include "analysis/report/sample.h"

enum { FACT = 512 }; // bytes, with the end

typedef void (*fact_fn)(const struct sample_session *session, char out[FACT]);

void fact_device(const struct sample_session *s, char out[FACT]);
void fact_driver(const struct sample_session *s, char out[FACT]);
void fact_display(const struct sample_session *s, char out[FACT]);
void fact_rate(const struct sample_session *s, char out[FACT]);
void fact_size(const struct sample_session *s, char out[FACT]);
void fact_fov(const struct sample_session *s, char out[FACT]);
void fact_seed(const struct sample_session *s, char out[FACT]);
void fact_version(const struct sample_session *s, char out[FACT]);
void fact_scenes(const struct sample_session *s, char out[FACT]);
void fact_observer(const struct sample_session *s, char out[FACT]);
void fact_protocol(const struct sample_session *s, char out[FACT]);
void fact_status(const struct sample_session *s, char out[FACT]);

// Cells pool sessions; where those differ in what was shown, the reader must know: "scenes, size". False: in
// nothing that is recorded.
bool facts_differing(const struct sample *sample, char *out, size_t out_size);

#endif
