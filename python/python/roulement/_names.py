"""Names that are not there."""

import difflib


def unknown(name, what, names):
    """KeyError of a name with those that are nearest to it."""
    names = list(names)
    # Upper and lower case are no difference that anyone means.
    lower = {of.lower(): of for of in names}
    near = [lower[of] for of in difflib.get_close_matches(str(name).lower(), lower, n=5, cutoff=0.6)]
    within = [of for of in names if str(name).lower() in of.lower() and of not in near]
    near = (near + within)[:5]
    return KeyError(f"{name} is no {what}" + (f"; near are {', '.join(near)}" if near else ""))
