# Reference values for analysis/stats/power_simulation: run with Rscript, writes power_simulation.csv beside itself.
# Columns: people, choices, share, sd, alpha, intercept (uniroot on integrate()), power, error (its standard error).
# Power: of the exact sign-flip test over 20,000 simulated studies, its distribution by all 2^N signs through an outer
# convolution on the half-integers; of one choice each without simulation, by binom.test's rule on the rejection region.
set.seed(20261125)
intercept <- function(share, sd) if (sd == 0) qlogis(share) else
  uniroot(function(b) integrate(function(z) plogis(b + sd * z) * dnorm(z), -Inf, Inf, rel.tol = 1e-11)$value - share,
          c(-30, 30), tol = 1e-12)$root
flip_p <- function(d) { # doubled sums are whole numbers
  w <- round(abs(2 * d)); total <- sum(w); mass <- c(1, numeric(total)) # index: sum of those with +, from 0
  for (x in w[w > 0]) { shifted <- c(numeric(x), mass[seq_len(total + 1 - x)]); mass <- (mass + shifted) / 2 }
  sum(mass[abs(2 * (0:total) - total) >= abs(sum(2 * d)) - 1e-9])
}
simulated <- function(people, choices, share, sd, alpha, studies = 20000) {
  b <- intercept(share, sd)
  reject <- replicate(studies, {
    k <- rbinom(people, choices, plogis(b + sd * rnorm(people)))
    flip_p(k - choices / 2) <= alpha
  })
  c(b, mean(reject), sqrt(mean(reject) * (1 - mean(reject)) / studies))
}
exact <- function(people, share, sd, alpha) {
  out <- sapply(0:people, function(k) binom.test(k, people)$p.value <= alpha)
  c(intercept(share, sd), sum(dbinom(0:people, people, share)[out]), 0)
}
rows <- list()
add <- function(people, choices, share, sd, alpha) {
  v <- if (choices == 1) exact(people, share, sd, alpha) else simulated(people, choices, share, sd, alpha)
  rows[[length(rows) + 1]] <<- paste(c(people, choices, share, sd, alpha, sprintf("%.15g", v)), collapse = ",")
}
add(22, 1, 0.75, 0, 0.05); add(22, 1, 0.8, 1, 0.05); add(22, 1, 0.3, 0.5, 0.01); add(40, 1, 0.65, 0, 0.05)
add(20, 20, 0.6, 0.5, 0.05); add(20, 20, 0.65, 1, 0.05); add(24, 40, 0.55, 0.5, 0.05); add(10, 9, 0.7, 0, 0.05)
add(12, 4, 0.25, 1.5, 0.05); add(5, 20, 0.9, 0.5, 0.05)
writeLines(c("people,choices,share,sd,alpha,intercept,power,error", unlist(rows)), "power_simulation.csv")
