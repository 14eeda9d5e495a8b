# Reference values for analysis/report/frames_pairs: run with Rscript, writes frames_pairs_times.csv (made-up frame times) and
# frames_pairs.csv beside itself. Base R only. Rows: difference (ms), log ratio, late share; columns: people for whom it is known,
# mean over people of the people's mean over trials, and the 95 % interval of t.test over people. Whether person 5's frames were late
# is not known, nor for person 2's second trial.
set.seed(4)
rows <- NULL
for (p in 1:5) for (trial in seq_len(1 + p %% 3)) for (o in c("t", "r")) {
  n <- sample(4:9, 1)
  rows <- rbind(rows, data.frame(p, trial, o, us = round(1000 * (ifelse(o == "t", 7, 9) + p / 3 + rexp(n))), late = rbinom(n, 1, 0.3)))
}
rows$late[rows$p == 5 | (rows$p == 2 & rows$trial == 2)] <- NA
per_trial <- do.call(rbind, lapply(split(rows, list(rows$p, rows$trial), drop = TRUE), function(x) {
  t <- x[x$o == "t", ]
  r <- x[x$o == "r", ]
  data.frame(p = x$p[1], difference = (median(t$us) - median(r$us)) / 1000, log_ratio = log(median(t$us) / median(r$us)),
             late = mean(t$late) - mean(r$late))
}))
out <- do.call(rbind, lapply(c("difference", "log_ratio", "late"), function(k) {
  known <- per_trial[!is.na(per_trial[[k]]), ]
  people <- tapply(known[[k]], known$p, mean)
  t <- t.test(people)
  data.frame(value = k, people = length(people), mean = sprintf("%.17g", t$estimate), low = sprintf("%.17g", t$conf.int[1]), high = sprintf("%.17g", t$conf.int[2]))
}))
here <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
write.csv(rows, file.path(here, "frames_pairs_times.csv"), row.names = FALSE, quote = FALSE)
write.csv(out, file.path(here, "frames_pairs.csv"), row.names = FALSE, quote = FALSE)
