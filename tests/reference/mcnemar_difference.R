# Reference values for analysis/stats/mcnemar_difference: run with Rscript, writes mcnemar_difference.csv beside itself.
# Of n people b said yes first and no then, c the other way round; b / n - c / n and its interval.
#   limits: Fay & Lumbard (2021), Statistics in Medicine 40, 1147-1159. Integrated over the share of b among b + c by
#     integrate() (the C code integrates over the share of b + c in n), solved by uniroot() to 1e-15.
#     Columns: limits, n, b, c, conf, low, high.
#   coverage: four 95 % intervals over every table of n people: Student's t of the differences, Newcombe (1998, Statistics
#     in Medicine 17, 2635-2650, method 10), Tango (1998, the same, 891-908), Fay & Lumbard. The true shares of b and c go
#     in steps of 1/40 over all pairs with at least one above 0 (of the others' yeses 0, 1/4, 1/2, 3/4, 1; only Newcombe's
#     depends on it). Where an interval does not exist it does not cover.
#     Columns: method, n, least coverage, mean coverage, mean width, tables (of b and c; Newcombe: of all four counts),
#     tables in which the interval leaves 0 out although the exact p (binom.test) is 0.05 or more, in which it holds 0
#     although p is less, in which it passes -1 or 1.
lines <- c("kind,n,b,c,conf,low,high")
row <- function(...) lines <<- c(lines, paste(c(...), collapse = ","))

# P(W <= x), W = D (2 T - 1), T ~ Beta(b, c + 1); D ~ Beta(m + 1, n - m) below 0 and Beta(m, n - m + 1) above.
reached <- function(x, b, c, n) {
  m <- b + c
  ends <- function(from, to) {
    q <- qbeta(pnorm(-9:9), b, c + 1)
    sort(unique(c(from, q[q > from & q < to], to)))
  }
  over <- function(f, from, to) {
    if (to <= from) return(0)
    e <- ends(from, to)
    sum(sapply(seq_len(length(e) - 1), function(i) integrate(f, e[i], e[i + 1], rel.tol = 1e-12, abs.tol = 1e-18,
                                                            subdivisions = 2000, stop.on.error = FALSE)$value))
  }
  if (x < 0)
    over(function(t) dbeta(t, b, c + 1) * pbeta(-x / (1 - 2 * t), m + 1, n - m, lower.tail = FALSE), 0, (1 + x) / 2)
  else
    pbeta(0.5, b, c + 1) + over(function(t) dbeta(t, b, c + 1) * pbeta(x / (2 * t - 1), m, n - m + 1), 0.5, 1)
}
lower <- function(b, c, n, tail) {
  m <- b + c
  if (b == 0) return(if (m == n) -1 else -qbeta(1 - tail, m + 1, n - m))
  below <- pbeta(0.5, b, c + 1) >= tail
  if (below && m == n) return(2 * qbeta(tail, b, c + 1) - 1)
  f <- function(x) reached(x, b, c, n) - tail
  if (below) uniroot(f, c(-1 + 1e-12, 0 - 1e-300), tol = 1e-15, maxiter = 500)$root
  else uniroot(f, c(1e-300, 1 - 1e-12), tol = 1e-15, maxiter = 500)$root
}
melded <- function(b, c, n, conf = 0.95) c(lower(b, c, n, (1 - conf) / 2), -lower(c, b, n, (1 - conf) / 2))

value <- function(b, c, n, conf) row("limits", n, b, c, sprintf("%.17g", c(conf, melded(b, c, n, conf))))
for (bc in list(c(0, 0), c(1, 0), c(5, 0), c(0, 5), c(6, 0), c(3, 2), c(12, 2), c(10, 10), c(20, 0), c(19, 1), c(15, 5),
                c(14, 6))) value(bc[1], bc[2], 20, 0.95)
value(1, 0, 1, 0.95); value(0, 0, 1, 0.95); value(1, 1, 2, 0.95); value(2, 0, 2, 0.9)
value(12, 2, 50, 0.95); value(30, 14, 100, 0.99); value(30, 14, 44, 0.8); value(400, 1, 401, 0.95)
value(86, 150, 600, 0.95); value(300, 251, 10000, 0.95); value(5100, 4900, 10000, 0.95); value(120, 0, 10000, 0.999)
value(3, 9990, 10000, 0.95)
set.seed(20210301)
for (i in 1:40) {
  n <- sample(c(5:60, 200, 1000, 3000), 1)
  m <- rbinom(1, n, runif(1)); b <- rbinom(1, m, runif(1))
  value(b, m - b, n, sample(c(0.8, 0.9, 0.95, 0.99), 1))
}

student <- function(b, c, n) {
  sd <- sqrt((b + c - (b - c)^2 / n) / (n - 1))
  if (sd > 0) (b - c) / n + c(-1, 1) * qt(0.975, n - 1) * sd / sqrt(n) else c(NA, NA)
}
tango <- function(b, c, n) {
  z <- function(d) {
    B <- -b - c + (2 * n - b + c) * d
    q <- (sqrt(pmax(0, B^2 + 8 * n * c * d * (1 - d))) - B) / (4 * n)
    (b - c - n * d) / sqrt(n * (2 * q + d * (1 - d)))
  }
  d <- (b - c) / n
  end <- function(to, sign) {
    f <- function(x) z(x) + sign * qnorm(0.975)
    inside <- d + (to - d) * 1e-9; outside <- to - sign * 1e-9
    if (d == to || f(inside) * f(outside) > 0) to else uniroot(f, sort(c(inside, outside)), tol = 1e-12)$root
  }
  c(end(-1, -1), end(1, 1))
}
wilson <- function(k, n) {
  z <- qnorm(0.975); p <- k / n
  middle <- (p + z^2 / (2 * n)) / (1 + z^2 / n); half <- z * sqrt(p * (1 - p) / n + z^2 / (4 * n^2)) / (1 + z^2 / n)
  cbind(middle - half, middle + half)
}
newcombe <- function(a, b, c, d) {
  n <- a + b + c + d; p <- (a + b) / n; q <- (a + c) / n
  x <- wilson(a + b, n); y <- wilson(a + c, n)
  top <- a * d - b * c; top <- ifelse(top > 0, pmax(top - n / 2, 0), top)
  under <- sqrt(a + b) * sqrt(c + d) * sqrt(a + c) * sqrt(b + d)
  phi <- ifelse(under > 0, top / under, 0)
  side <- function(u, v) sqrt(pmax(0, u^2 - 2 * phi * u * v + v^2))
  cbind(p - q - side(p - x[, 1], y[, 2] - q), p - q + side(x[, 2] - p, q - y[, 1]))
}
compare <- function(method, n, tables, ci, rest) {
  b <- tables[, 2]; c <- tables[, 3]
  p <- mapply(function(b, m) if (m == 0) 1 else binom.test(b, m)$p.value, b, b + c)
  out <- !is.na(ci[, 1]) & (ci[, 1] > 0 | ci[, 2] < 0); holds <- !is.na(ci[, 1]) & !out
  grid <- expand.grid(i = 0:40, j = 0:40, rest = rest)
  grid <- grid[grid$i + grid$j > 0 & grid$i + grid$j <= 40 & grid$i >= grid$j, ]
  each <- lgamma(n + 1) - rowSums(lgamma(tables + 1))
  covered <- width <- numeric(nrow(grid))
  for (g in seq_len(nrow(grid))) {
    x <- grid$i[g] / 40; y <- grid$j[g] / 40; left <- max(0, (40 - grid$i[g] - grid$j[g]) / 40)
    shares <- if (length(rest) > 1) c(left * grid$rest[g], x, y, left * (1 - grid$rest[g])) else c(left, x, y)
    logs <- sapply(log(shares), function(l) max(l, -1e4))
    weight <- exp(each + drop(tables %*% logs))
    hit <- !is.na(ci[, 1]) & ci[, 1] <= x - y + 1e-12 & ci[, 2] >= x - y - 1e-12
    covered[g] <- sum(weight[hit]); width[g] <- sum((weight * (ci[, 2] - ci[, 1]))[!is.na(ci[, 1])])
  }
  row(method, n, sprintf("%.10g", c(min(covered), mean(covered), mean(width))), nrow(tables), sum(out & p >= 0.05),
      sum(holds & p < 0.05), sum(!is.na(ci[, 1]) & (ci[, 1] < -1 - 1e-12 | ci[, 2] > 1 + 1e-12)))
}
lines <- c(lines, "method,n,least,mean,width,tables,out_at_large_p,holds_at_small_p,beyond_one")
for (n in c(10, 20, 40)) {
  two <- expand.grid(b = 0:n, c = 0:n); two <- two[two$b + two$c <= n, ]
  three <- cbind(n - two$b - two$c, two$b, two$c)
  compare("student", n, three, t(mapply(student, two$b, two$c, n)), 0)
  compare("tango", n, three, t(mapply(tango, two$b, two$c, n)), 0)
  four <- expand.grid(a = 0:n, b = 0:n, c = 0:n); four <- four[rowSums(four) <= n, ]
  four <- as.matrix(cbind(four, n - rowSums(four)))
  compare("newcombe", n, four, newcombe(four[, 1], four[, 2], four[, 3], four[, 4]), (0:4) / 4)
  low <- mapply(lower, two$b, two$c, n, 0.025)
  other <- match(paste(two$c, two$b), paste(two$b, two$c))
  compare("melded", n, three, cbind(low, -low[other]), 0)
}
writeLines(lines, "mcnemar_difference.csv")
