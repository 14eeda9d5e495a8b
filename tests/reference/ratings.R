# Expected numbers of the ratings that tests/analysis/test_ratings.c writes into a study file: run with Rscript, writes
# ratings.csv beside itself. A line: name, value.
out <- c()
add <- function(name, ...) out <<- c(out, sprintf("%s,%.17g", name, c(...)))
# Rates over region x epsilon, two of each. Person 7 has one rating of small at 0.1 only, person 8 none of full at 0.2.
regions <- c("small", "large", "full")
value <- function(i, r, f, rep) 1 + (i * 7 + r * 5 + f * 3 + i * r * f + rep * 2) %% 7 + r
rows <- expand.grid(rep = 0:1, f = 0:1, r = 0:2, person = 1:8)
rows <- subset(rows, !(person == 7 & r == 0 & f == 0 & rep == 1) & !(person == 8 & r == 2 & f == 1))
rows$y <- with(rows, value(person, r, f, rep))
rows$region <- factor(regions[rows$r + 1])
rows$epsilon <- factor(c(0.1, 0.2)[rows$f + 1])
cells <- aggregate(y ~ person + region + epsilon, rows, mean)
cells <- subset(cells, person != 8)
cells$person <- factor(cells$person)
tables <- lapply(summary(aov(y ~ region * epsilon + Error(person / (region * epsilon)), cells)), function(s) s[[1]])
errors <- sum(sapply(tables, function(t) t["Residuals", "Sum Sq"]))
wide <- with(cells, tapply(y, list(person, paste(region, epsilon)), mean)) # columns: full 0.1, full 0.2, large 0.1, ...
idata <- expand.grid(epsilon = factor(1:2), region = factor(1:3))
ssd <- structure(list(SSD = crossprod(scale(wide, scale = FALSE)), df = nrow(wide) - 1), class = "SSD")
eps <- list(region = stats:::sphericity(ssd, M = ~region, X = ~1, idata = idata),
            "region:epsilon" = stats:::sphericity(ssd, M = ~region * epsilon, X = ~region + epsilon, idata = idata))
for (t in tables[-1]) {
  term <- trimws(rownames(t)[1])
  name <- sub(":", "_x_", term)
  f <- t[1, "F value"]; d <- t[1, "Df"]; e <- t["Residuals", "Df"]; ss <- t[1, "Sum Sq"]
  gg <- if (is.null(eps[[term]])) 1 else eps[[term]]$GG.eps
  hf <- if (is.null(eps[[term]])) 1 else min(1, eps[[term]]$HF.eps)
  add(paste0(name, ".f"), f)
  add(paste0(name, ".p_value"), t[1, "Pr(>F)"])
  add(paste0(name, ".epsilon_gg"), gg)
  add(paste0(name, ".epsilon_hf"), hf)
  add(paste0(name, ".p_gg"), pf(f, d * gg, e * gg, lower.tail = FALSE))
  add(paste0(name, ".p_hf"), pf(f, d * hf, e * hf, lower.tail = FALSE))
  add(paste0(name, ".eta2_partial"), ss / (ss + t["Residuals", "Sum Sq"]))
  add(paste0(name, ".eta2_generalised"), ss / (ss + errors))
}
by_region <- with(cells, tapply(y, list(person, region), mean))
z <- by_region - rowMeans(by_region) + mean(by_region)
for (r in sort(regions)) {
  add(paste0(r, ".mean"), mean(by_region[, r]))
  add(paste0(r, ".within_half_width"), diff(t.test(z[, r])$conf.int) / 2 * sqrt(3 / 2))
}
add("small.percent_below", 100 * with(subset(rows, person != 8 & region == "small"), mean(y < 5.5)))
add("full.percent_above", 100 * with(subset(rows, person != 8 & region == "full"), mean(y > 5.5)))
pairs <- combn(sort(regions), 2)
tests <- apply(pairs, 2, function(p) t.test(by_region[, p[1]], by_region[, p[2]], paired = TRUE), simplify = FALSE)
holm <- p.adjust(sapply(tests, function(t) t$p.value), "holm")
for (k in 1:3) {
  name <- paste(pairs[, k], collapse = "_")
  add(paste0(name, ".estimate"), tests[[k]]$estimate)
  add(paste0(name, ".t"), tests[[k]]$statistic)
  add(paste0(name, ".p_value"), tests[[k]]$p.value)
  add(paste0(name, ".p_holm"), holm[k])
}
# Both options of a trial in the cells I and II; person 6 answered cell II twice, person 5 rated one option of cell I.
test <- function(i, c) 1 + (i * 5 + c * 2) %% 7
reference <- function(i, c) 3 + (i * 3 + c * 4) %% 6
enumerate <- function(d, pratt = FALSE) {
  if (!pratt) d <- d[d != 0]
  r <- rank(abs(d)); v <- sum(r[d > 0]); r <- r[d != 0]
  sums <- 0
  for (x in r) sums <- c(sums, sums + x)
  min(1, 2 * min(mean(sums <= v + 1e-9), mean(sums >= v - 1e-9)))
}
ps <- c()
for (c in 1:2) {
  i <- if (c == 1) c(1:4, 6) else 1:6
  x <- test(i, c); y <- reference(i, c)
  if (c == 2) { x[6] <- (x[6] + 9) / 2; y[6] <- (y[6] + 2) / 2 }
  t <- t.test(x, y, paired = TRUE)
  name <- c("I", "II")[c]
  add(paste0(name, ".test_mean"), mean(x))
  add(paste0(name, ".reference_sd"), sd(y))
  add(paste0(name, ".estimate"), t$estimate)
  add(paste0(name, ".t"), t$statistic)
  add(paste0(name, ".ci_low"), t$conf.int[1])
  add(paste0(name, ".rank_p"), enumerate(x - y))
  add(paste0(name, ".d"), mean(x - y) / sd(x - y))
  ps <- c(ps, t$p.value)
}
add("I.p_holm", p.adjust(ps, "holm")[1])
add("II.p_holm", p.adjust(ps, "holm")[2])
# The ratings before and after of tests/analysis/study_file.c (small_study.R), by ranks
change <- c(1, 1, 1, 1, 1, 1, 1, -1, -1, 0, 0)
add("test_first.rank_p", enumerate(change))
first <- c(6, 7, 5, 8, 6, 4, 6, 7, 9, 6, 6)
add("test_first.d_av", mean(change) / ((sd(first) + sd(first + change)) / 2))
add("test_first.d", mean(change) / sd(change))
change <- c(-2, -2, -1, -1, -1, -1, 0, 0, 0)
add("regular_first.rank_p", enumerate(change))
add("regular_first.d", mean(change) / sd(change))
# Person 2 up by 3 and person 8 down by 2: zeros that take their ranks along change p
change <- c(1, 3, 1, 1, 1, 1, 1, -2, -1, 0, 0)
stopifnot(enumerate(change) != enumerate(change, TRUE))
add("changed.rank_p", enumerate(change))
add("changed.pratt_p", enumerate(change, TRUE))
# Before and after with a repeated trial (test_ratings_edges.c): who saw time_warped first, rated regular and then
# time_warped again has no first rating. first, second of persons 3 and 5, and of 2, 4 and 6:
test <- list(first = c(7, 6), second = c(8, 9)); regular <- list(first = c(6, 5, 7), second = c(7, 8, 9))
for (name in c("test", "regular")) {
  x <- get(name); t <- t.test(x$second, x$first, paired = TRUE)
  add(paste0("order.", name, ".estimate"), t$estimate)
  add(paste0("order.", name, ".p_value"), t$p.value)
}
w <- t.test(regular$first, test$first)
add("order.between.estimate", -diff(w$estimate))
add("order.between.p_value", w$p.value)
# Three sittings averaged: changes as fractions, sums of second less first over how many
change <- c(3, -1, 3, -1, 3, 1, 2) / c(3, 1, 3, 1, 3, 1, 1)
add("sittings.rank_v", sum(rank(abs(change))[change > 0]))
add("sittings.rank_p", enumerate(change))
writeLines(out, "ratings.csv")
