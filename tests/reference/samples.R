# Reference values for analysis/stats ttest, moments and quantile: run with Rscript, writes samples.csv beside itself.
# A line: test, alternative, conf, expected numbers (six, by the test), then x, then y; numbers of a list by spaces.
#   one, paired, welch: estimate, t, df, p, low, high      moments: n, mean, sd, standard error, NA, NA
#   quantile: quantiles of type 7 at 0, 0.05, 0.5, 0.95, 0.99, 1
set.seed(20210606)
lines <- c()
show <- function(x) paste(sprintf("%.17g", x), collapse = " ")
add <- function(test, alternative, conf, numbers, x, y = c())
  lines <<- c(lines, paste(test, alternative, sprintf("%.17g", conf), show(numbers), show(x), show(y), sep = ","))
t_numbers <- function(t, estimate) c(estimate, t$statistic, t$parameter, t$p.value, t$conf.int)
alternatives <- c("two.sided", "less", "greater")
one <- function(x, a, conf) {
  t <- t.test(x, alternative = a, conf.level = conf)
  add("one", a, conf, t_numbers(t, t$estimate), x)
}
# Franke 2021, section 8.2: n 11, sum +5, sum of squares 9; n 9, sum -8, sum of squares 12
one(c(1, 1, 1, 1, 1, 1, 1, -1, -1, 0, 0), "two.sided", 0.95)
one(c(-2, -2, -1, -1, -1, -1, 0, 0, 0), "two.sided", 0.95)
for (i in 1:40) {
  n <- sample(2:40, 1)
  a <- sample(alternatives, 1)
  conf <- sample(c(0.8, 0.9, 0.95, 0.99), 1)
  x <- switch(sample(3, 1), sample(1:10, n, TRUE), round(rnorm(n, 5, 2), 3), 1e6 + round(rnorm(n), 2))
  y <- switch(sample(3, 1), sample(1:10, n, TRUE), round(rnorm(n, 5, 2), 3), x + round(rnorm(n), 2))
  z <- round(rnorm(sample(2:30, 1), 5, 3), 2)
  if (sd(x) > 0) one(x, a, conf)
  if (sd(x - y) > 0) {
    t <- t.test(x, y, paired = TRUE, alternative = a, conf.level = conf)
    add("paired", a, conf, t_numbers(t, t$estimate), x, y)
  }
  if (sd(x) + sd(z) > 0) {
    t <- t.test(x, z, alternative = a, conf.level = conf)
    add("welch", a, conf, t_numbers(t, t$estimate[1] - t$estimate[2]), x, z)
  }
  add("moments", "two.sided", 0.95, c(n, mean(x), sd(x), sd(x) / sqrt(n), NA, NA), x)
  add("quantile", "two.sided", 0.95, quantile(x, c(0, 0.05, 0.5, 0.95, 0.99, 1), type = 7), x)
}
writeLines(lines, "samples.csv")
