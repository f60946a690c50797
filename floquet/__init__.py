from floquet.monodromy import Monodromy as Monodromy
from floquet.monodromy import monodromy as monodromy
