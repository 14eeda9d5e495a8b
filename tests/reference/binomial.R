# Reference values for analysis/stats/binomial: run with Rscript, writes binomial.csv beside itself.
# Columns: k, n, p0, alternative, conf, then binom.test's p-value and interval, then the null region by trying every k
# (n up to 200 only, else -1; that scan is binom.test again, not our method).
set.seed(20210605)
rows <- list()
add <- function(k, n, p, alternative, conf) {
  t <- binom.test(k, n, p, alternative, conf)
  low <- -1
  high <- -1
  if (n <= 200) {
    inside <- which(sapply(0:n, function(j) binom.test(j, n, p, alternative)$p.value) > 1 - conf) - 1
    low <- min(inside)
    high <- max(inside)
  }
  rows[[length(rows) + 1]] <<- sprintf("%d,%d,%.17g,%s,%.17g,%.17g,%.17g,%.17g,%d,%d", as.integer(k), as.integer(n),
                                       p, alternative, conf, t$p.value, t$conf.int[1], t$conf.int[2],
                                       as.integer(low), as.integer(high))
}
alternatives <- c("two.sided", "less", "greater")
for (n in c(1, 2, 5, 19, 20, 21, 22, 42))
  for (k in unique(c(0, 1, n %/% 4, n %/% 2, n - 1, n)))
    for (a in alternatives) add(k, n, 0.5, a, 0.95)
for (k in 0:22) add(k, 22, 0.5, "two.sided", 0.95)
for (n in c(7, 12, 40, 150)) # ties and near ties away from one half; p0 at its ends
  for (p in c(0, 0.1, 0.25, 1 / 3, 0.5, 0.75, 0.9, 1))
    for (k in unique(c(0, round(n * p), n %/% 3, n))) add(k, n, p, sample(alternatives, 1), 0.95)
for (i in 1:220) {
  n <- sample(1:200, 1)
  p <- sample(c(0.5, 0.5, round(runif(1), 3)), 1)
  add(rbinom(1, n, runif(1)), n, p, sample(alternatives, 1), sample(c(0.5, 0.8, 0.9, 0.95, 0.99, 0.999), 1))
}
for (i in 1:120) { # large n, around the expected count so that p does not vanish
  n <- round(10^runif(1, 3, 6))
  p <- sample(c(0.5, 0.5, 0.01, 0.3, 0.97, round(runif(1), 4)), 1)
  k <- min(n, max(0, round(n * p + rnorm(1, 0, 3) * sqrt(n * p * (1 - p)))))
  add(k, n, p, sample(alternatives, 1), sample(c(0.9, 0.95, 0.99), 1))
}
for (n in c(1e3, 1e4, 1e5, 1e6)) for (k in c(0, 1, n / 2, n - 1, n)) add(k, n, 0.5, "two.sided", 0.95)
writeLines(c("k,n,p0,alternative,conf,p_value,ci_low,ci_high,null_low,null_high", unlist(rows)), "binomial.csv")
