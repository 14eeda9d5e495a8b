// Which departures from the null hypothesis count.
#ifndef ANALYSIS_STATS_ALTERNATIVE_H
#define ANALYSIS_STATS_ALTERNATIVE_H

enum stat_alternative { STAT_TWO_SIDED, STAT_LESS, STAT_GREATER };

#endif
