# %% [markdown]
# # The report in ten minutes
#
# A NASA contractor report of the 1960s asks when a free-free beam, pushed by a gimbaled thrust
# T0 (1 + gamma cos Omega t), is stable. It answers with an infinite determinant that it cuts off
# after a few harmonics. Here is what becomes of its tables when nothing is cut off.
#
# The cells run from top to bottom in any editor that knows `# %%`, or as a script; behind `# `
# stands what is printed. The last expression of a cell shows itself in a notebook.

# %% [markdown]
# ## One printed row
#
# Table 1, Omega = .398, the first resonance. Print says T = .02834: unstable.

# %%
from compare import verify

row = verify(rows=["T1-07"])
found = row.outcomes[0]
print(found.row.T, found.verdict_printed, found.verdict)  # 0.02834 unstable stable
row

# %% [markdown]
# ## Two routes to the same polynomial
#
# Hill's determinant with its tail summed, and the monodromy matrix in the time domain. They give
# the same P(z), whose roots are cos 2 pi alpha: all of them real, simple and between -1 and 1 is
# stable.

# %%
from hill import UniformBeam, characteristic

beam = UniformBeam(T0=20.0, K_theta=0.5, xi_G=0.5, modes=2)
equation = beam.equation(Omega=found.row.Omega, gamma=0.1)
by_determinant = characteristic(equation)
print(by_determinant.z.real.round(5))  # [-0.23684 -0.26468 -0.99896]
by_determinant

# %%
from floquet import monodromy

by_time = monodromy(equation)
difference = abs(by_time.polynomial - by_determinant.polynomial).max()
print(difference <= by_time.error + by_determinant.error)  # True
by_time

# %% [markdown]
# ## Why print has it wrong
#
# The same determinant, cut off as the report cuts it off, puts a root beyond -1. What is left out
# falls only like the cube of the number of harmonics kept.

# %%
cut_off = characteristic(equation, truncation="report")
print(cut_off.z.real.min() < -1.0 < by_determinant.z.real.min())  # True
for harmonics in (2, 4, 8, 16):
    off = abs(characteristic(equation, truncation=harmonics).z - by_determinant.z).max()
    print(f"{harmonics:2d} harmonics: z is off by {off:.0e}")

# %% [markdown]
# ## The beam, let go
#
# Over two hundred periods the row that print calls unstable stays where it is; the next resonance
# grows, and as fast as its T says: like exp(T tau/2).

# %%
from floquet import simulate

still = simulate(equation, q0=[1.0, 1.0, 1.0], v0=[0.0, 0.0, 0.0], periods=200)
print(abs(still.q).max() < 10.0, still.error.max() < 1e-6)  # True True

resonant = beam.equation(Omega=1.1, gamma=0.1)
growing = simulate(resonant, q0=[1.0, 1.0, 1.0], v0=[0.0, 0.0, 0.0], periods=200)
print(abs(growing.q).max() > 1e6)  # True

# %% [markdown]
# ## Where else it is unstable
#
# A chart knows P everywhere between a few hundred evaluations by both routes.

# %%
from compare import chart, instabilities

c = chart(beam, [("Omega", 0.9, 2.1, 240), ("gamma", 0.0, 0.2, 120)])
for i in instabilities(c, orders=1):
    print(i.resonance.name, f"{i.width:.4f} wide at gamma = {i.y:g}")
c

# %% [markdown]
# ## Proven
#
# And so that nobody has to believe in rounding: both routes again in ball arithmetic, from the
# parameters as they are written (extra `proof`).

# %%
import floquet
import hill

for route in (hill, floquet):
    print(route.enclose(beam, Omega=repr(found.row.Omega), gamma="0.1").verdict)  # stable

# %% [markdown]
# All 89 printed values: `verify`. As pages to hand on: `verify report --output pages`.
