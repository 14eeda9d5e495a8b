# Reference values for analysis/stats/people_equivalence: run with Rscript, writes people_equivalence.csv.
# Two one-sided t-tests (t.test) of the shares k / n against p0 - margin and p0 + margin, and the interval with
# 1 - 2 alpha. Columns: k, n, p0, margin, alpha, p of the lower end, p of the upper end, low, high.
set.seed(20211106)
lines <- c("k,n,p0,margin,alpha,p_low,p_high,low,high")
add <- function(k, n, p0, margin, alpha) {
  x <- k / n
  low <- t.test(x, mu = p0 - margin, alternative = "greater")
  high <- t.test(x, mu = p0 + margin, alternative = "less")
  ci <- t.test(x, conf.level = 1 - 2 * alpha)$conf.int
  lines <<- c(lines, paste(c(paste(k, collapse = " "), paste(n, collapse = " "),
                             sprintf("%.17g", c(p0, margin, alpha, low$p.value, high$p.value, ci))), collapse = ","))
}
add(c(5, 4, 6, 5, 5, 5, 4, 6), rep(10, 8), 0.5, 0.1, 0.05)
add(c(5, 5, 6, 5, 5, 9), rep(10, 6), 0.5, 0.2, 0.05)
add(c(0, 10), c(10, 10), 0.5, 0.5, 0.05)
add(c(0, 0, 1, 0), c(4, 4, 4, 8), 0.5, 0.1, 0.01)
for (i in 1:20) {
  people <- sample(5:25, 1)
  n <- sample(2:40, people, replace = TRUE)
  add(rbinom(people, n, runif(1, 0.3, 0.7)), n, sample(c(0.5, 0.4), 1), sample(c(0.05, 0.15, 0.25), 1),
      sample(c(0.01, 0.05, 0.1), 1))
}
writeLines(lines, "people_equivalence.csv")
