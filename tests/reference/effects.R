# Reference values for analysis/report/effects and analysis/stats/signflip_values: run with Rscript, writes
# effects_answers.csv (made-up choices) and effects.csv (what the checks of effects.h give on them) beside itself. Base R only.
# Columns of effects.csv: study, check, people, estimate (mean of the people's values), low, high, d (t.test), p (all 2^N
# signs, one by one, where there are at most 16 people, else t.test), holm (p.adjust within the study). NA where there is none, p also where all values are 0.
# Repetition is expected by averaging over random orders' neighbours: the share of unordered pairs of answers that are alike.
# Place and repetition are of one sitting: a person's value is the sittings' mean, weighted by their pairs of answers.
set.seed(20)
make <- function(study, people, n, prefer = 0.5, side = 0, toggles = function() rpois(1, 3), fixed = FALSE) {
  rows <- NULL
  for (p in seq_len(people)) for (i in seq_len(n)) {
    slot <- if (fixed) "a" else sample(c("a", "b"), 1)
    first <- sample(c("a", "b"), 1)
    g <- toggles()
    last <- if (g %% 2 == 0) first else setdiff(c("a", "b"), first)
    like <- if (is.na(prefer)) NA else prefer + side * (slot == "a") - side * (slot == "b")
    test <- is.na(like) || runif(1) < like
    chosen <- if (test) slot else setdiff(c("a", "b"), slot)
    rows <- rbind(rows, data.frame(study, p, i, slot, first, last, chosen, g, a_ms = sample(1000:5000, 1), b_ms = sample(1000:5000, 1), sitting = 1))
  }
  rows
}
# The second sitting has another preference and goes on counting; the last person's has one answer.
sittings <- function(study, people) {
  x <- make(study, people, 7, 0.85)
  y <- make(study, people, 6, 0.15)
  y <- transform(y, i = i + 7, sitting = 2)
  rbind(x, y[y$p < people | y$i == 8, ])
}
data <- rbind(make("eight", 8, 9, 0.4), make("sided", 12, 10, 0.5, 0.35), make("one person", 1, 9),
              make("all the same", 6, 5, NA), make("no toggles", 7, 6, 0.5, 0, function() 0),
              make("one side", 7, 6, 0.6, 0, fixed = TRUE), make("single answers", 10, 1), make("many", 64, 8, 0.45),
              sittings("two sittings", 9))

strata <- function(held, test) {
  if (2 * min(sum(held), sum(!held)) < max(sum(held), sum(!held))) return(NA)
  (mean(test[held]) + mean(!test[!held])) / 2 - 0.5
}
# c(value, pairs) of a sitting; no pairs where it says nothing.
place <- function(x) {
  test <- x$chosen == x$slot
  n <- nrow(x)
  h <- n %/% 2
  if (h) c(mean(test[(n - h + 1):n]) - mean(test[1:h]), h) else c(0, 0)
}
repetition <- function(x) {
  n <- nrow(x)
  if (length(unique(x$chosen)) < 2) return(c(0, 0))
  pairs <- combn(n, 2)
  c(mean(x$chosen[-1] == x$chosen[-n]) - mean(x$chosen[pairs[1, ]] == x$chosen[pairs[2, ]]), n - 1)
}
of_sittings <- function(each) {
  v <- do.call(rbind, each)
  if (sum(v[, 2])) sum(v[, 1] * v[, 2]) / sum(v[, 2]) else NA
}
value <- function(check, x) {
  test <- x$chosen == x$slot
  view <- ifelse(x$slot == "a", x$a_ms, x$b_ms) / (x$a_ms + x$b_ms)
  both <- any(test) && !all(test)
  each <- split(x, x$sitting)
  switch(check,
    side = strata(x$slot == "a", test), first = strata(x$first == x$slot, test), last = strata(x$last == x$slot, test),
    place = of_sittings(lapply(each, place)), repetition = of_sittings(lapply(each, repetition)),
    toggles = if (both) mean(x$g[test]) - mean(x$g[!test]) else NA,
    viewing = if (both) mean(view[test]) - mean(view[!test]) else NA)
}
flip <- function(v) {
  sums <- as.matrix(expand.grid(rep(list(c(-1, 1)), length(v)))) %*% v
  mean(abs(sums) >= abs(sum(v)) - 1e-10 * sum(abs(v)))
}
out <- NULL
for (s in unique(data$study)) {
  rows <- NULL
  for (check in c("side", "first", "last", "place", "repetition", "toggles", "viewing")) {
    x <- data[data$study == s, ]
    v <- sapply(split(x, x$p), function(y) value(check, y))
    v <- unname(v[!is.na(v)])
    t <- tryCatch(t.test(v), error = function(e) NULL)
    p <- if (length(v) < 2 || all(v == 0)) NA else if (length(v) <= 16) flip(v) else t$p.value
    row <- data.frame(study = s, check, people = length(v), estimate = if (length(v)) mean(v) else NA,
                      low = if (is.null(t)) NA else t$conf.int[1], high = if (is.null(t)) NA else t$conf.int[2],
                      d = if (is.null(t)) NA else mean(v) / sd(v), p)
    rows <- rbind(rows, row)
  }
  rows$holm <- p.adjust(rows$p, "holm")
  out <- rbind(out, rows)
}
here <- dirname(sub("^--file=", "", grep("^--file=", commandArgs(FALSE), value = TRUE)))
options(digits = 17)
write.csv(data, file.path(here, "effects_answers.csv"), row.names = FALSE, quote = FALSE)
numbers <- sapply(out, is.numeric)
out[numbers] <- lapply(out[numbers], function(x) ifelse(is.na(x), "NA", sprintf("%.17g", x)))
write.csv(out, file.path(here, "effects.csv"), row.names = FALSE, quote = FALSE)
