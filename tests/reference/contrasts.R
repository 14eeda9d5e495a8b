# Reference values for analysis/report/choice_contrasts: run with Rscript, writes contrasts.csv beside itself.
# Six people in cells of factor a (levels 3, 2, 1) by scene (x, y); person p chose the test option
# (7 p + 3 a + 5 [scene is y]) %% 10 times of 10; person 6 has no answers in cell (1, y).
# Twenty people in cells of factor b (levels 4 to 1), who answered once: the test option where
# (5 p + 3 b + p b) %% 7 < b + 1; person 1 answered at level 4 a second time, for the other option.
# Columns: factor, level, other level, people, difference, low, high, t, p, Holm's p over the factor's pairs.
share <- function(p, a, s) if (p == 6 && a == 1 && s == 1) NA else ((7 * p + 3 * a + 5 * s) %% 10) / 10
rows <- character(0)
compare <- function(factor, levels, of, people = 1:6) {
  pairs <- combn(seq_along(levels), 2)
  t <- lapply(seq_len(ncol(pairs)), function(i) {
    d <- sapply(people, function(p) mean(of(p, pairs[1, i]) - of(p, pairs[2, i]), na.rm = TRUE))
    t.test(d)
  })
  holm <- p.adjust(sapply(t, `[[`, "p.value"), "holm")
  for (i in seq_along(t))
    rows <<- c(rows, sprintf("%s,%s,%s,%d,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g", factor, levels[pairs[1, i]],
                             levels[pairs[2, i]], t[[i]]$parameter + 1, t[[i]]$estimate, t[[i]]$conf.int[1],
                             t[[i]]$conf.int[2], t[[i]]$statistic, t[[i]]$p.value, holm[i]))
}
compare("a", c("3", "2", "1"), function(p, i) sapply(0:1, function(s) share(p, 4 - i, s)))
compare("scene", c("x", "y"), function(p, i) sapply(3:1, function(a) share(p, a, i - 1)))
once <- function(p, b) (if (p == 1 && b == 4) 0.5 else 1) * ((5 * p + 3 * b + p * b) %% 7 < b + 1)
compare("b", c("4", "3", "2", "1"), function(p, i) once(p, 5 - i), 1:20)
writeLines(c("factor,a,b,people,difference,low,high,t,p,holm", rows), "contrasts.csv")
