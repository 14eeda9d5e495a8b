# Reference values for studies/engine/quest_plus: run with Rscript, writes quest_plus.csv beside itself.
# Brute force from Watson 2017 (Journal of Vision 17(3):10): for every level and outcome the posterior that this outcome
# would leave, its entropy (-sum p ln p), and the sum of entropies weighted with the outcome's probability; the level
# with the smallest sum is next, the first one of those within 1e-12. Nothing is in logarithms and nothing precomputed.
# Functions: R's own distributions (plogis, pnorm, pweibull) where it has them. Answers: a simulated observer drawn with
# R's generator, or a fixed pattern.
# Lines: setting,name,family,outcomes,falling,level,threshold,slope,guess,lapse   (grids: min max count log)
#        trial,level,outcome,entropy,expected,means,sds   expected: for this trial, before the answer; means and sds of
#        slope guess lapse threshold 1.. after it.        (guess is 0 where the model has none)
set.seed(20170310)
grid <- function(min, max, count, log = FALSE) {
  values <- if (count == 1) min else if (log) exp(seq(log(min), log(max), length.out = count)) else
    seq(min, max, length.out = count)
  list(values = values, text = sprintf("%.17g %.17g %d %d", min, max, as.integer(count), as.integer(log)), log = log)
}
none <- list(values = 0, text = "0 0 0 0", log = FALSE)

# Probability of passing one threshold t with slope b at level x.
pass <- function(family, falling, log_axis, x, t, b) {
  if (family == "weibull") {
    if (falling) return(1 - exp(-(x / t)^(-b)))
    return(pweibull(x, shape = b, scale = t))
  }
  d <- if (log_axis) log(x / t) else x - t
  if (falling) d <- -d
  switch(family, logistic = plogis(b * d), normal = pnorm(d, sd = 1 / b), gumbel = 1 - exp(-exp(b * d)))
}
# One column per outcome, one row per parameter set.
psi <- function(s, x, sets) {
  passed <- sapply(seq_len(s$outcomes - 1), function(k)
    pass(s$family, s$falling, s$level$log, x, sets[[paste0("t", k)]], sets$slope))
  passed <- matrix(passed, ncol = s$outcomes - 1)
  if (s$outcomes == 2) {
    right <- sets$guess + (1 - sets$guess - sets$lapse) * passed[, 1]
    return(cbind(1 - right, right))
  }
  at_least <- cbind(1, passed, 0)
  p <- at_least[, 1:s$outcomes] - at_least[, 2:(s$outcomes + 1)]
  (1 - sets$lapse) * p + sets$lapse / s$outcomes
}
entropy <- function(p) -sum(ifelse(p > 0, p * log(p), 0))

parameter_sets <- function(s) {
  thresholds <- rep(list(s$threshold$values), s$outcomes - 1)
  names(thresholds) <- paste0("t", seq_len(s$outcomes - 1))
  sets <- expand.grid(c(thresholds, list(slope = s$slope$values, guess = s$guess$values, lapse = s$lapse$values)))
  for (k in seq_len(s$outcomes - 2)) { # strictly in order of difficulty
    easy <- sets[[paste0("t", k)]]
    hard <- sets[[paste0("t", k + 1)]]
    sets <- sets[if (s$falling) easy > hard else easy < hard, ]
  }
  sets
}

lines <- character()
gaps <- numeric()
run <- function(name, family, outcomes, falling, level, threshold, slope, guess, lapse, trials, truth, pattern = NULL) {
  s <- list(family = family, outcomes = outcomes, falling = falling, level = level, threshold = threshold,
            slope = slope, guess = guess, lapse = lapse)
  sets <- parameter_sets(s)
  lines[length(lines) + 1] <<- paste("setting", name, family, outcomes, as.integer(falling), level$text, threshold$text,
                                     slope$text, guess$text, lapse$text, sep = ",")
  likelihood <- lapply(level$values, function(x) psi(s, x, sets))
  posterior <- rep(1 / nrow(sets), nrow(sets))
  columns <- c("slope", "guess", "lapse", paste0("t", seq_len(outcomes - 1)))
  for (trial in seq_len(trials)) {
    expected <- sapply(likelihood, function(l) {
      sum(sapply(seq_len(outcomes), function(r) {
        joint <- posterior * l[, r]
        p <- sum(joint)
        if (p > 0) p * entropy(joint / p) else 0
      }))
    })
    chosen <- which(expected <= min(expected) + 1e-12)[1]
    untied <- expected[expected > min(expected) + 1e-12]
    gaps[length(gaps) + 1] <<- if (length(untied)) min(untied) - min(expected) else Inf
    x <- level$values[chosen]
    outcome <- if (is.null(pattern)) sample(0:(outcomes - 1), 1, prob = psi(s, x, as.data.frame(truth))) else
      pattern[(trial - 1) %% length(pattern) + 1]
    posterior <- posterior * likelihood[[chosen]][, outcome + 1]
    posterior <- posterior / sum(posterior)
    means <- sapply(columns, function(c) sum(posterior * sets[[c]]))
    sds <- sapply(columns, function(c) sqrt(sum(posterior * (sets[[c]] - sum(posterior * sets[[c]]))^2)))
    lines[length(lines) + 1] <<- sprintf("trial,%.17g,%d,%.17g,%.17g,%s,%s", x, as.integer(outcome), entropy(posterior),
                                         expected[chosen], paste(sprintf("%.17g", means), collapse = " "),
                                         paste(sprintf("%.17g", sds), collapse = " "))
  }
}

run("logistic", "logistic", 2, FALSE, grid(-2, 2, 25), grid(-2, 2, 23), grid(0.5, 8, 7, TRUE), grid(0.5, 0.5, 1),
    grid(0, 0.08, 3), 80, list(t1 = 0.37, slope = 2.5, guess = 0.5, lapse = 0.02))
run("normal falling", "normal", 2, TRUE, grid(0, 20, 31), grid(1, 19, 29), grid(0.1, 1.5, 5, TRUE),
    grid(0.25, 0.35, 3), grid(0.01, 0.05, 3), 80, list(t1 = 7.7, slope = 0.4, guess = 0.3, lapse = 0.03))
run("Weibull logarithmic", "weibull", 2, FALSE, grid(0.01, 1, 33, TRUE), grid(0.02, 0.8, 31, TRUE),
    grid(1, 6, 6), grid(0.5, 0.5, 1), grid(0.01, 0.04, 2), 80, list(t1 = 0.13, slope = 3.1, guess = 0.5, lapse = 0.02))
run("Weibull linear falling", "weibull", 2, TRUE, grid(0.1, 4, 27), grid(0.3, 3.5, 21),
    grid(1, 5, 5), grid(0.5, 0.5, 1), grid(0.02, 0.02, 1), 60, list(t1 = 1.4, slope = 2.2, guess = 0.5, lapse = 0.02))
# Watson's first example: contrast threshold in dB, slope 3.5 per his Weibull, guess 0.5, lapse 0.02.
run("Gumbel in dB", "gumbel", 2, FALSE, grid(-40, 0, 41), grid(-40, 0, 41),
    grid(3.5 * log(10) / 20, 3.5 * log(10) / 20, 1), grid(0.5, 0.5, 1), grid(0.02, 0.02, 1), 64,
    list(t1 = -20, slope = 3.5 * log(10) / 20, guess = 0.5, lapse = 0.02))
run("logistic logarithmic falling", "logistic", 2, TRUE, grid(0.05, 5, 30, TRUE),
    grid(0.1, 4, 24, TRUE), grid(1, 9, 5, TRUE), grid(0, 0, 1), grid(0, 0.1, 5), 80,
    list(t1 = 0.9, slope = 4, guess = 0, lapse = 0.04))
run("alternating answers", "normal", 2, FALSE, grid(-3, 3, 31), grid(-3, 3, 31), grid(0.5, 4, 6, TRUE),
    grid(0.5, 0.5, 1), grid(0.01, 0.1, 4), 100, NULL, c(1, 0))
run("all wrong", "logistic", 2, FALSE, grid(-3, 3, 31), grid(-3, 3, 31), grid(0.5, 4, 6, TRUE), grid(0.5, 0.5, 1),
    grid(0.02, 0.02, 1), 60, NULL, 0)
run("3 outcomes normal", "normal", 3, FALSE, grid(-4, 4, 33), grid(-3, 3, 17), grid(0.4, 4, 6, TRUE), none,
    grid(0.02, 0.02, 1), 80, list(t1 = -0.8, t2 = 0.9, slope = 1.5, lapse = 0.02))
run("3 outcomes Weibull", "weibull", 3, FALSE, grid(0.05, 5, 25, TRUE), grid(0.1, 4, 15, TRUE), grid(1, 5, 5), none,
    grid(0, 0.06, 3), 80, list(t1 = 0.5, t2 = 1.6, slope = 2.7, lapse = 0.02))
run("4 outcomes logistic falling", "logistic", 4, TRUE, grid(0, 10, 26), grid(0.5, 9.5, 13),
    grid(0.6, 4, 4, TRUE), none, grid(0.01, 0.05, 2), 80, list(t1 = 7.9, t2 = 5.2, t3 = 2.4, slope = 1.7, lapse = 0.02))
run("4 outcomes Gumbel", "gumbel", 4, FALSE, grid(-5, 5, 26), grid(-4, 4, 12), grid(0.5, 3, 4), none,
    grid(0, 0, 1), 80, list(t1 = -2.2, t2 = 0.3, t3 = 2.1, slope = 1.2, lapse = 0))
cat(sprintf("%d trials; smallest distance of a chosen level's expected entropy to the next: %.3g nats\n", length(gaps),
            min(gaps)))
writeLines(lines, "quest_plus.csv")
