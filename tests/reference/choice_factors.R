# Reference values for analysis/report/choice_factors: run with Rscript, writes choice_factors.csv beside itself.
# Five studies of eight to eighteen people; yes(p, l) says whether person p chose the test option at level l.
#   within2: 18 people, levels 1, 2, person 18 without level 2. McNemar: binom.test of those who differ; the interval of
#     the difference after Fay & Lumbard (2021), Statistics in Medicine 40, 1147-1159: quantile of D (2 T - 1), here
#     integrated over T.
#   within3: 8 people, levels 1 to 3. Cochran's Q with every placement of each person's yeses.
#   between2: 17 people, odd ones at level 1. fisher.test, chisq.test; Newcombe's interval from prop.test's Wilson.
#   between3: 17 people, person p at level p %% 3 + 1. fisher.test of the 3 x 2 table, and of its pairs.
#   several2: 9 people, odd ones at level 1, ten answers each. All 126 divisions of the people; Welch of the shares.
# Columns: study, pair (1 2, or 0 0 for all levels), people, p, statistic, chi-squared p, difference, low, high,
# odds ratio, low, high.
yes <- function(p, l) as.integer((7 * p + 4 * l + p * l) %% 5 < 2 + l %% 2)
lines <- c("study,a,b,people,p,statistic,p_asymptotic,difference,low,high,odds,odds_low,odds_high")
add <- function(study, pair, ...) lines <<- c(lines, paste(study, pair[1], pair[2],
                                                           paste(sprintf("%.17g", c(...)), collapse = ","), sep = ","))
lower <- function(b, c, n, tail = 0.025) {
  m <- b + c
  if (b == 0) return(if (m == n) -1 else -qbeta(1 - tail, m + 1, n - m))
  negative <- pbeta(0.5, b, c + 1) >= tail
  if (negative && m == n) return(2 * qbeta(tail, b, c + 1) - 1)
  over <- function(f, ends) integrate(f, ends[1], ends[2], rel.tol = 1e-12, subdivisions = 5000)$value
  reached <- if (negative) function(x) over(function(t)
    dbeta(t, b, c + 1) * pbeta(-x / (1 - 2 * t), m + 1, n - m, lower.tail = FALSE), c(0, (1 + x) / 2))
  else function(x) pbeta(0.5, b, c + 1) + over(function(t)
    dbeta(t, b, c + 1) * pbeta(x / (2 * t - 1), m, n - m + 1), c(0.5, 1))
  uniroot(function(x) reached(x) - tail, if (negative) c(-1 + 1e-9, -1e-9) else c(1e-9, 1 - 1e-9), tol = 1e-14)$root
}
mcnemar <- function(study, pair, people) {
  x <- yes(people, pair[1]); y <- yes(people, pair[2])
  b <- sum(x > y); c <- sum(x < y)
  exact <- binom.test(b, b + c)
  chi <- (b - c)^2 / (b + c)
  ends <- exact$conf.int / (1 - exact$conf.int)
  add(study, pair, length(people), exact$p.value, chi, pchisq(chi, 1, lower.tail = FALSE), mean(x - y),
      lower(b, c, length(people)), -lower(c, b, length(people)),
      b / c, ends)
}
mcnemar("within2", 1:2, 1:17)

m <- sapply(1:3, function(l) yes(1:8, l))
Q <- function(m) { C <- colSums(m); R <- rowSums(m); k <- ncol(m)
  (k - 1) * (k * sum(C^2) - sum(C)^2) / (k * sum(R) - sum(R^2)) }
ways <- lapply(rowSums(m), function(r) if (r %in% c(0, 3)) list(rep(r / 3, 3)) else
  lapply(1:3, function(j) { v <- rep(if (r == 1) 0 else 1, 3); v[j] <- 1 - v[j]; v }))
grid <- expand.grid(lapply(ways, seq_along))
q <- apply(grid, 1, function(g) Q(t(mapply(function(w, i) w[[i]], ways, g))))
add("within3", c(0, 0), 8, mean(q >= Q(m) - 1e-9), Q(m), pchisq(Q(m), 2, lower.tail = FALSE), rep(NaN, 6))
for (pair in list(c(1, 2), c(1, 3), c(2, 3))) mcnemar("within3", pair, 1:8)

between <- function(study, pair, one, two) {
  k <- c(sum(yes(one, pair[1])), sum(yes(two, pair[2]))); n <- c(length(one), length(two))
  f <- fisher.test(rbind(c(k[1], n[1] - k[1]), c(k[2], n[2] - k[2])))
  x2 <- suppressWarnings(chisq.test(rbind(k, n - k), correct = FALSE))
  w <- suppressWarnings(lapply(1:2, function(i) prop.test(k[i], n[i], correct = FALSE)$conf.int))
  p <- k / n; d <- p[1] - p[2]
  add(study, pair, sum(n), f$p.value, x2$statistic, x2$p.value, d, d - sqrt((p[1] - w[[1]][1])^2 + (w[[2]][2] - p[2])^2),
      d + sqrt((w[[1]][2] - p[1])^2 + (p[2] - w[[2]][1])^2), f$estimate, f$conf.int)
}
between("between2", 1:2, seq(1, 17, 2), seq(2, 16, 2))
at <- lapply(1:3, function(l) (1:17)[1:17 %% 3 + 1 == l])
k <- sapply(1:3, function(l) sum(yes(at[[l]], l)))
table <- cbind(k, lengths(at) - k)
x2 <- suppressWarnings(chisq.test(table, correct = FALSE))
add("between3", c(0, 0), 17, fisher.test(table)$p.value, x2$statistic, x2$p.value, rep(NaN, 6))
for (pair in list(c(1, 2), c(1, 3), c(2, 3))) between("between3", pair, at[[pair[1]]], at[[pair[2]]])

count <- sapply(1:9, function(p) (3 * p + 4 * (p %% 2) + 1) %% 11)
chi <- function(g) suppressWarnings(chisq.test(rbind(c(sum(count[g]), sum(10 - count[g])),
                                                     c(sum(count[-g]), sum(10 - count[-g]))), correct = FALSE)$statistic)
data <- chi(seq(1, 9, 2))
all <- apply(combn(9, 5), 2, chi)
t <- t.test(count[seq(1, 9, 2)] / 10, count[seq(2, 8, 2)] / 10)
add("several2", 1:2, 9, mean(all >= data - 1e-9), data, NaN, t$estimate[1] - t$estimate[2], t$conf.int, NaN, NaN, NaN)
writeLines(lines, "choice_factors.csv")
