# Scales of preferences under two sets of rules (tests/analysis/test_what_if.c): run with Rscript, writes what_if.csv
# beside itself. A line: name, value. Of two options Thurstone's case V has a closed form: the share of answers for
# one of them as a normal quantile, over that of 3/4, which is one JOD. Time_warped was preferred to regular in 60 of 80
# trials; the rules take out one of those 60.
jod <- function(k, n) qnorm(k / n) / qnorm(3 / 4)
writeLines(sprintf("%s,%.17g", c("scale.all", "scale.rules"), c(jod(60, 80), jod(59, 79))), "what_if.csv")
