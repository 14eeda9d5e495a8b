// A study file as a BIDS dataset: participants, sessions, answers (beh), what was shown when (events) and the
// eye tracker's samples with fixations and saccades (physio, physioevents). Rules: BIDS 1.11.1, whose eye
// tracking is Szinte et al., Eye-Tracking-BIDS (extension proposal 20). A person is a subject, a sitting a
// session, a run of the program (segment) a run: every time of a run is in seconds since its own time 0.
#ifndef ANALYSIS_TOOLS_BIDS_H
#define ANALYSIS_TOOLS_BIDS_H

#include "studies/store/read.h"

struct bids_counts {
    int64_t participants, sessions, runs;
    int64_t recordings, samples;  // of the eye tracker: files and rows in them
    int64_t samples_without_rate; // of recordings whose sampling frequency is not estimable; not written
};

// Into an empty folder. The same file gives the same bytes. Rows of gaze are not held. False with a sentence.
bool bids_write(struct store_reader *reader, const char *folder, struct bids_counts *out, char *error,
                size_t error_size);

#endif
